#include "python/options.h"

#include "python/convert.h"

namespace hapsim::python {

Options::Options(const py::kwargs& keywords) {
  hs_options* made = nullptr;
  require(hs_options_new(&made));
  options_.reset(made);
  for (const auto& [key, value] : keywords) {
    std::string name = py::str(key);
    for (char& c : name)
      if (c == '_') c = '-';
    if (name == "say") {
      if (!value.is_none()) say_ = py::reinterpret_borrow<py::object>(value);
    } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
      for (const py::handle& one : value) set(name, one);
    } else if (!value.is_none()) {
      set(name, value);
    }
  }
  hs_options_listen(made, say, stop, this);
}

void Options::set(const std::string& name, const py::handle& value) {
  std::string text;
  if (py::isinstance<py::bool_>(value))
    text = value.cast<bool>() ? "true" : "false";
  else if (py::isinstance<py::str>(value) || PyIndex_Check(value.ptr()) != 0)
    text = py::str(value);
  else if (PyNumber_Check(value.ptr()) != 0)
    text = py::repr(py::float_(py::reinterpret_borrow<py::object>(value)));
  else
    text = path_of(py::reinterpret_borrow<py::object>(value));
  require(hs_options_set(options_.get(), name.c_str(), text.c_str()));
}

void Options::say(void* context, const char* words) {
  const py::gil_scoped_acquire lock;
  const Options& self = *static_cast<const Options*>(context);
  if (self.say_.is_none() || PyErr_Occurred() != nullptr) return;
  try {
    self.say_(words);
  } catch (py::error_already_set& error) {
    error.restore();
  }
}

int Options::stop(void*) {
  const py::gil_scoped_acquire lock;
  return PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0 ? 1 : 0;
}

}  // namespace hapsim::python
