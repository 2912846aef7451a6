// STL triangle soup, ASCII and binary, told apart by content.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

using TriangleSoup = std::vector<std::array<Vec3, 3>>;

// Error(kBadInput): truncated, count that the file cannot hold, NaN, no triangle.
TriangleSoup parse_stl(const std::string& bytes, const std::string& name);
void write_stl_binary(std::ostream& out, const TriangleSoup& soup);
void write_stl_ascii(std::ostream& out, const TriangleSoup& soup);

}  // namespace hapsim
