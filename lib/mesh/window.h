// The window through which a body was seen that goes on beyond it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// "window x y z x y z ...", as a comment of PLY.
std::string window_comment(const std::vector<Vec3>& window);
// Of such a comment, lengths multiplied by `factor`; empty: there is none that can be read.
std::vector<Vec3> window_of(const std::vector<std::string>& comments, double factor = 1);

// Whether a point lies inside the polygon in plan view (x, y).
bool inside_window(const std::vector<Vec3>& window, const Vec3& p);

}  // namespace hapsim
