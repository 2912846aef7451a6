// Exceptions in place of statuses: hapsim.Error, and one below it for each status.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "c/hapsim.h"

namespace hapsim::python {

namespace py = pybind11;
using namespace py::literals;

void define_errors(py::module_& m);

// Throws where the C interface did not do what it was asked for, in its words.
void require(hs_status status);
[[noreturn]] void fail(hs_status status, const std::string& words);

}  // namespace hapsim::python
