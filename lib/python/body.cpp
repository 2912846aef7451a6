#include "python/body.h"

#include <string>

#include "python/arrays.h"
#include "python/convert.h"
#include "python/options.h"

namespace hapsim::python {
namespace {

Body read_body_file(const py::object& path) {
  hs_body* body = nullptr;
  const std::string file = path_of(path);
  run([&] { return hs_body_read(file.c_str(), &body); });
  return {owned<hs_body, hs_body_free>(body)};
}

template <class Number>
py::array array(const py::object& self, const Number* (*get)(const hs_body*, std::size_t*),
                std::size_t columns, std::size_t shown = 0) {
  std::size_t count = 0;
  const Number* data = get(self.cast<Body&>().handle.get(), &count);
  return table(data, count, columns, self, shown == 0 ? columns : shown);
}

py::array tets(const py::object& self) {
  std::size_t count = 0;
  const std::int32_t* data = hs_body_tetrahedra(self.cast<Body&>().handle.get(), &count);
  return table(data, count, 10, self, data[4] < 0 ? 4 : 10);
}

}  // namespace

void define_body(py::module_& m) {
  py::class_<Body>(m, "Body", "Tetrahedra with fixed nodes.")
      .def_static("read", &read_body_file, "path"_a, "Of any format that the tools read.")
      .def_property_readonly("name", [](const Body& b) { return hs_body_name(b.handle.get()); })
      .def_property_readonly(
          "nodes", [](const py::object& b) { return array(b, hs_body_nodes, 3); },
          "n x 3 [m], a view")
      .def_property_readonly(
          "fixed", [](const py::object& b) { return array(b, hs_body_fixed, 1); },
          "n, 1: bonded to the support")
      .def_property_readonly("tets", &tets, "indices of 4 nodes, or of 10")
      .def_property_readonly("regions",
                             [](const py::object& b) { return array(b, hs_body_regions, 1); })
      .def_property_readonly(
          "faces", [](const py::object& b) { return array(b, hs_body_faces, 3); },
          "boundary triangles, outward")
      .def("__repr__", [](const py::object& b) {
        return py::str("<hapsim.Body {}: {} nodes, {} tetrahedra>")
            .format(b.attr("name"), py::len(b.attr("nodes")), py::len(b.attr("tets")));
      });
}

}  // namespace hapsim::python
