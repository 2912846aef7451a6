#include "python/feel.h"

#include <pybind11/numpy.h>

namespace hapsim::python {
namespace {

py::array_t<double> array_of(const double* values) {
  return py::array_t<double>(3, values);
}

}  // namespace

void define_feel(py::module_& m) {
  py::class_<hs_feel>(m, "Feel", "What a tool felt at its last step.")
      .def_readonly("press", &hs_feel::press)
      .def_property_readonly("contact", [](const hs_feel& f) { return f.contact != 0; })
      .def_readonly("beyond", &hs_feel::beyond)
      .def_readonly("safety", &hs_feel::safety)
      .def_property_readonly("point", [](const hs_feel& f) { return array_of(f.point); })
      .def_property_readonly("u", [](const hs_feel& f) { return array_of(f.u); })
      .def_property_readonly("force", [](const hs_feel& f) { return array_of(f.force); })
      .def_readonly("uncertainty", &hs_feel::uncertainty)
      .def_property_readonly("asked", [](const hs_feel& f) { return array_of(f.asked); });
}

}  // namespace hapsim::python
