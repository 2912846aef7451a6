// Outputs that can be made, before the work that they are made of.
#pragma once

#include <string>

namespace hapsim {

// Error(kIo), as Output's, where such an output could not be made now; nothing is made.
void require_output(const std::string& path_or_dash);

}  // namespace hapsim
