// Comparison: a measured recording against a simulated one.
#pragma once

#include "python/errors.h"

namespace hapsim::python {

void define_comparison(py::module_& m);

}  // namespace hapsim::python
