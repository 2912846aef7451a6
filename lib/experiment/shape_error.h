// How far the contact points lie off the body's surface, and how uncertain that makes its
// stiffness.
#pragma once

#include <string>

#include "experiment/places.h"

namespace hapsim {

struct ShapeError {
  double before = 0;        // rms distance of the contact points from the surface [m]
  double after = 0;         // ... from the surface moved as well as a rigid move can
  double farthest = 0;      // [m]
  Vec3 at = Vec3::Zero();   // the point that lies farthest off [m]
  double least_extent = 0;  // of the body along an axis [m]
  // Relative error of a contact stiffness where the body is that much thicker or thinner: a layer's
  // stiffness goes with the reciprocal of its thickness, a deep body's less (so this is an upper
  // estimate). What a move explains is an effect (shift), no uncertainty, unless it did not happen.
  double share() const { return least_extent > 0 ? after / least_extent : 0; }
  double share_unmoved() const { return least_extent > 0 ? before / least_extent : 0; }
  bool plain() const;         // more than scans leave
  std::string words() const;  // "" unless plain
};

ShapeError shape_error(const Places& places);

}  // namespace hapsim
