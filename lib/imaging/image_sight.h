// How deep an image sees, and how finely.
#pragma once

#include <string>
#include <vector>

#include "imaging/image_values.h"

namespace hapsim {

// The standard error of log E from which on a factor of 2 is within the 95 %: nothing is resolved.
double unresolved_log_std();

struct ImageSight {
  // Distance from a pressed place as far as which E is known within a factor of 2, with 95 % [m];
  // 0: nowhere.
  double reach = 0;
  double finest = 0;    // resolution (image_values.h) of what is nearest to presses [m]
  double at_reach = 0;  // about that distance [m]
};

// By medians of groups of tetrahedra at growing distance. `pressed`: places on the surface, not
// empty.
ImageSight image_sight(const TetMesh& body, const ImageValues& values,
                       const std::vector<Vec3>& pressed);

// In a sentence or two.
std::string sight_words(const ImageSight& sight);

}  // namespace hapsim
