// Where else a body could be pressed.
#pragma once

#include <vector>

#include "contact/contact_library.h"

namespace hapsim {

// At most `count` places of the surface between the pressed positions and a little around them,
// each as far as can be from all of these and from each other: no farther from the nearest pressed
// one than most of these are from theirs, no nearer than a tool's radius, and facing about its way.
std::vector<Vec3> unpressed_places(const Surface& surface,
                                   const std::vector<PreparedContact>& pressed, double tool_radius,
                                   std::size_t count);

}  // namespace hapsim
