// Where the surface lay before the touching probe pushed it in.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/surface.h"
#include "scan/scan.h"

namespace hapsim {

// What resists the probe: a stated stiffness, or a half-space of modulus E under a rigid tip.
struct TouchModel {
  std::optional<double> stiffness;  // [N/m]
  double E = 0;                     // [Pa]
  double nu = 0.5;
  double tip_radius = 0;  // [m]
  bool flat = false;      // a flat end instead of a ball
};

// Indentation under `force` [N]: F / k; a ball by Hertz, (3 F / (4 E* sqrt R))^(2/3); a flat end,
// F / (2 E* R), with E* = E / (1 - nu^2). K. L. Johnson, Contact Mechanics, 1985, eqs. (4.23) and
// (3.36).
double indentation(double force, const TouchModel& model);

struct TouchReport {
  double least = 0, mean = 0, largest = 0;  // indentation [m]
};

// Moves every point outward along its normal (scan.cloud.normals must be there) by the indentation
// of its scan.touch_force. Error(kBadInput, name): an indentation larger than `most` [m].
TouchReport undo_touch(Scan& scan, const TouchModel& model, double most, const std::string& name);

}  // namespace hapsim
