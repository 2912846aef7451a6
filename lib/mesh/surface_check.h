// What must hold before a surface may reach a mesher.
#pragma once

#include <string>

#include "mesh/surface.h"

namespace hapsim {

// What can be told without geometry search: indices, finite coordinates, no doubled vertex, no flat
// triangle, every edge with two faces, one part, outward, not flat. Error(kBadInput) naming the
// place and what to do.
void check_surface(const Surface& surface, const std::string& where);

}  // namespace hapsim
