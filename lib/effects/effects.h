// The effects' single objects; each is defined in the file of its name.
#pragma once

#include "effects/effect.h"

namespace hapsim {

const Effect& backlash_effect();
const Effect& elastic_effect();
const Effect& regions_effect();
const Effect& layer_effect();
const Effect& inclusion_effect();
const Effect& anisotropic_effect();
const Effect& base_effect();
const Effect& shift_effect();
const Effect& hyperelastic_effect();
const Effect& temperature_effect();
const Effect& softening_effect();
const Effect& viscoelastic_effect();
const Effect& damper_effect();
const Effect& tip_effect();
const Effect& slack_effect();
const Effect& friction_effect();
const Effect& adhesion_effect();
const Effect& sensor_rotation_effect();
const Effect& sensor_gain_effect();
const Effect& sensor_curve_effect();
const Effect& sensor_lag_effect();
const Effect& sensor_bias_effect();
const Effect& sensor_drift_effect();
const Effect& deadband_effect();
const Effect& tare_effect();

}  // namespace hapsim
