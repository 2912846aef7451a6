#include "python/convert.h"

namespace hapsim::python {

std::string path_of(const py::object& path) {
  return py::str(py::module_::import("os").attr("fspath")(path));
}

py::object from_json(const char* text) {
  return py::module_::import("json").attr("loads")(text);
}

py::dict metadata_of(const std::function<const char*(std::size_t)>& key,
                     const std::function<const char*(const char*)>& value) {
  py::dict all;
  for (std::size_t k = 0; const char* name = key(k); ++k) all[name] = value(name);
  return all;
}

}  // namespace hapsim::python
