// Body: tetrahedra with fixed nodes.
#pragma once

#include <memory>

#include "python/errors.h"

namespace hapsim::python {

struct Body {
  std::shared_ptr<hs_body> handle;
};

void define_body(py::module_& m);

}  // namespace hapsim::python
