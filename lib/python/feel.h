// Feel: what a tool felt at its last step.
#pragma once

#include "python/errors.h"

namespace hapsim::python {

void define_feel(py::module_& m);

}  // namespace hapsim::python
