// Model: effects with the values of their parameters; and what makes and uses one: simulate and
// identify.
#pragma once

#include <memory>

#include "python/errors.h"

namespace hapsim::python {

struct Model {
  std::shared_ptr<hs_model> handle;
  py::object summary = py::none();  // of identify(), as by --json
};

void define_model(py::module_& m);

}  // namespace hapsim::python
