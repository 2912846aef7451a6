// A nominal block or cylinder as a body's surface, for recordings of machines that press on one.
#pragma once

#include <string>

#include "base/vec3.h"
#include "mesh/surface.h"

namespace hapsim {

struct Block {
  Vec3 size = Vec3::Zero();  // [m]
  bool round = false;        // a cylinder, its axis along z
};

// "120x80x40mm", "0.12,0.08,0.04": three lengths of a block; "50x30mm": a cylinder's diameter and
// height. Error(kUsage) unless all are positive.
Block parse_block(const std::string& text);
// "0.12 x 0.08 x 0.04 m", "diameter 0.05, height 0.03 m"
std::string block_words(const Block& block);

// Closed surface, triangles outward, standing on z = 0 with its axis at x = y = 0; of a cylinder a
// prism of 64 sides and its volume.
Surface block_surface(const Block& block);

// The radius of the least disc about the axis that covers the block [m].
double covering_radius(const Block& block);

}  // namespace hapsim
