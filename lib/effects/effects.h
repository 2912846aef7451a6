// The effects' single objects; each is defined in the file of its name.
#pragma once

#include "effects/effect.h"

namespace hapsim {

const Effect& elastic_effect();
const Effect& regions_effect();
const Effect& hyperelastic_effect();
const Effect& viscoelastic_effect();
const Effect& damper_effect();
const Effect& sensor_lag_effect();
const Effect& sensor_bias_effect();
const Effect& sensor_drift_effect();

}  // namespace hapsim
