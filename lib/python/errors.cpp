#include "python/errors.h"

#include <array>

namespace hapsim::python {
namespace {

std::array<PyObject*, 6> errors{};

}  // namespace

void define_errors(py::module_& m) {
  const auto define = [&](int code, const char* name, const char* words, PyObject* base) {
    const std::string full = std::string("hapsim.") + name;
    py::dict members("code"_a = code);
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), words, base, members.ptr());
    m.attr(name) = py::reinterpret_borrow<py::object>(type);
    return type;
  };
  PyObject* base = define(0, "Error", "What hapsim cannot do, in the words of its tools.", nullptr);
  errors.fill(base);
  errors[HS_USAGE] = define(HS_USAGE, "UsageError", "An option is wrong.", base);
  errors[HS_BAD_INPUT] =
      define(HS_BAD_INPUT, "BadInputError", "A file or an array cannot be used.", base);
  errors[HS_NO_CONVERGENCE] = define(HS_NO_CONVERGENCE, "NoConvergenceError",
                                     "A numerical method failed or was stopped.", base);
  errors[HS_IO] = define(HS_IO, "IoError", "Reading or writing failed.", base);
}

void require(hs_status status) {
  if (status == HS_DONE) return;
  if (PyErr_Occurred() == nullptr)  // else it was stopped by an exception of Python
    PyErr_SetString(errors.at(static_cast<std::size_t>(status)), hs_message());
  throw py::error_already_set();
}

[[noreturn]] void fail(hs_status status, const std::string& words) {
  PyErr_SetString(errors.at(static_cast<std::size_t>(status)), words.c_str());
  throw py::error_already_set();
}

}  // namespace hapsim::python
