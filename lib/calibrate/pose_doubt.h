// Poses whose forces are no weight's.
#pragma once

#include <string>

#include "calibrate/sensor_fit.h"

namespace hapsim {

// A sentence where a fit leaves more than a tenth of the weight: the orientations are the inverse
// ones (of the base in the tool), which leaves a fifth or less; or something else is not as the
// table says. "" where the fit leaves less.
std::string pose_doubt(const SensorFit& fit, const StaticPoses& poses,
                       const SensorOptions& options);

}  // namespace hapsim
