// Where the fit of a sensor begins.
#pragma once

#include "calibrate/sensor_model.h"
#include "calibrate/sensor_unknowns.h"

namespace hapsim {

// Sign, rotation, mass and offset of a sensor without cross-talk in closed form: the rotation and
// scale between two sets of vectors, the weights in the tool's frame and the forces (Umeyama, IEEE
// Trans. Pattern Anal. 13, 1991), for the mass beside known weights that leaves least. `start` has
// gravity, temp_ref, and with Scale::kKnownMass the mass. Poses that lie in a plane do not tell the
// sign: 1.
SensorState closed_form(const StaticPoses& poses, Scale scale, const SensorState& start);

}  // namespace hapsim
