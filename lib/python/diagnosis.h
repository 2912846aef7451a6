// Diagnosis: which physical effect a model lacks, and what to record next.
#pragma once

#include "python/errors.h"

namespace hapsim::python {

void define_diagnosis(py::module_& m);

}  // namespace hapsim::python
