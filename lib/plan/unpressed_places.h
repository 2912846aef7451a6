// Where else a body could be pressed.
#pragma once

#include <vector>

#include "contact/contact_library.h"

namespace hapsim {

// At most `count` places on the surface, chosen one by one, each as far as possible from the
// pressed positions and from those chosen before. A place qualifies when its nearest pressed
// position is
//   - at least a tool's radius away,
//   - at most three quarters of the pressed positions' typical spacing away, and
//   - facing about the same way (normals within 45 degrees).
std::vector<Vec3> unpressed_places(const Surface& surface,
                                   const std::vector<PreparedContact>& pressed, double tool_radius,
                                   std::size_t count);

}  // namespace hapsim
