// How far a ball's law may err that takes the body in series with the material under the tool.
#pragma once

#include "experiment/experiment.h"

namespace hapsim {

// Relative uncertainty of the stiffness at each position under a declared ball: a tenth of what the
// body adds to the stiffness of a half-space under the disc (its thickness, its support, the law in
// series), at most a half. On layers as thick as the contact E is off by up to 0.26, of which this
// is 0.2 to 0.3 (bench/real/balls.py). Empty where no ball is declared.
std::vector<double> series_doubt(const Places& places, const Dataset& dataset, double nu);

}  // namespace hapsim
