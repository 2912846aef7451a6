// Recording: presses, measured or simulated, or a motion of them.
#pragma once

#include <memory>

#include "python/errors.h"

namespace hapsim::python {

struct Recording {
  std::shared_ptr<hs_recording> handle;

  static Recording adopt(hs_recording* made);
};

void define_recording(py::module_& m);

}  // namespace hapsim::python
