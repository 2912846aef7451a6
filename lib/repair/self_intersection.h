// Triangles of a surface that cut each other.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Pairs of triangles that cut each other, lower number first, ascending; empty for a clean surface.
// Error(kBadInput) when its triangles meet as no surface can.
std::vector<std::pair<int, int>> intersecting_faces(const Surface& surface,
                                                    const std::string& where);
// Error(kBadInput) naming the first pairs of triangles that cut each other.
void check_self_intersection(const Surface& surface, const std::string& where);

}  // namespace hapsim
