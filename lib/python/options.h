// What is asked for by keywords: fix="nu=0.45", tool_radius=0.004, folds=0; and how it is done.
#pragma once

#include <memory>
#include <string>

#include "python/errors.h"

namespace hapsim::python {

class Options {
 public:
  explicit Options(const py::kwargs& keywords);
  Options(const Options&) = delete;
  const hs_options* get() const { return options_.get(); }

 private:
  struct Free {
    void operator()(hs_options* o) const { hs_options_free(o); }
  };
  void set(const std::string& name, const py::handle& value);
  // Of a thread that waits without Python's lock.
  static void say(void* context, const char* words);
  static int stop(void* context);

  std::unique_ptr<hs_options, Free> options_;
  py::object say_ = py::none();
};

// `call` without Python's lock.
template <class Call>
void run(const Call& call) {
  hs_status status;
  {
    const py::gil_scoped_release free;
    status = call();
  }
  require(status);
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();  // of `say`
}

}  // namespace hapsim::python
