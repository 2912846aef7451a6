// How stiff each pressed place is over what a model says of it.
#pragma once

#include <vector>

#include "fit/fit.h"
#include "plan/spread_places.h"

namespace hapsim {

// By position of the experiment: the log gains of its presses (image_views()), their mean weighted
// by 1 / variance; NaN where none is told from noise.
std::vector<SeenPlace> seen_places(const Fit& fitted, const Experiment& experiment);

// Where presses were, when nothing is asked of their forces.
std::vector<SeenPlace> pressed_places(const Recording& recording);

}  // namespace hapsim
