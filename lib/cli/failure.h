// What becomes of whatever was thrown.
#pragma once

#include <string>

#include "base/error.h"

namespace hapsim {

struct Failure {
  ExitCode code = ExitCode::kNoConvergence;
  std::string words;  // "" where there is nothing to say: a closed pipe
};

// Of the exception that is being handled, whichever it is.
Failure current_failure();

}  // namespace hapsim
