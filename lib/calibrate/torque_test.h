// Whether the torques show the force itself.
#pragma once

#include "calibrate/sensor_fit.h"

namespace hapsim {

// The chance (F test) that the torques' residuals follow the weight by no more than noise. A centre
// of mass gives torques square to the weight, through a skew matrix; a symmetric one beside it is a
// sensor whose torques show forces, and then the centre of mass is as far off. 1 without torques.
double torque_follows_force(const SensorFit& fit, const StaticPoses& poses);

}  // namespace hapsim
