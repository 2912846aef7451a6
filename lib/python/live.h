// Live: one tool, a force within microseconds.
#pragma once

#include "python/errors.h"

namespace hapsim::python {

void define_live(py::module_& m);

}  // namespace hapsim::python
