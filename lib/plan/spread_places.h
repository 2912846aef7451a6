// Where to press so that most becomes known of how a body differs from place to place.
#pragma once

#include <vector>

#include "plan/pressable_places.h"

namespace hapsim {

// What was seen of a place: the log of its stiffness over what was expected.
struct SeenPlace {
  Vec3 point;
  double gain = 0;  // NaN: pressed, but not said how stiff it is
};

// Places among `places`, one by one, each the one that lowers the variance of a Gaussian process
// over all of them most (Seo et al., IJCNN 2000), about what `seen` leaves of it. Its length is
// 1.1 times the spacing that the presses will have, half of it where gains are known; never below
// `least_length` [m], the width of what is looked for. With gains, a place's variance counts more
// where the process's mean lies off: by 1 + (mean / standard deviation of the gains)^2, up to ten
// times; or as `weight` of each of `places` says.
std::vector<PressablePlace> spread_places(const std::vector<PressablePlace>& places,
                                          const std::vector<SeenPlace>& seen, double least_length,
                                          std::size_t count,
                                          const std::vector<double>& weight = {});

}  // namespace hapsim
