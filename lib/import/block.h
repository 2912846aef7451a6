// A nominal block as a body's surface, for recordings of machines that press on one.
#pragma once

#include <string>

#include "base/vec3.h"
#include "mesh/surface.h"

namespace hapsim {

// "120x80x40mm", "0.12,0.08,0.04": three lengths [m]. Error(kUsage) unless all are positive.
Vec3 parse_block(const std::string& text);

// Closed surface, triangles outward, standing on z = 0 with its axis at x = y = 0.
Surface block_surface(const Vec3& size);

}  // namespace hapsim
