// Every effect: one line in this list and one file. A test may ask for an effect by its function;
// nothing else does, for the catalogue has them all.
#pragma once

#include "effects/effect.h"

namespace hapsim {

// In the order in which a force passes through them: motion, body, support, contact, sensor.
// clang-format off
#define HAPSIM_EFFECTS(X) \
  X(motion_scale) X(motion_rotation) X(backlash) X(touch) X(breathing) X(plastic) \
  X(elastic) X(regions) X(layer) X(inclusion) X(anisotropic) X(pre_stress) X(hyperelastic) \
  X(temperature) X(softening) X(viscoelastic) X(fractional) X(poroelastic) X(qlv) X(damper) \
  X(base) X(shift) \
  X(tool_radius) X(tip) X(slack) X(friction) X(adhesion) X(learned_place) X(learned_depth) \
  X(learned_kernel) X(arm_compliance) X(drag) X(tool_inertia) X(sensor_rotation) \
  X(sensor_crosstalk) X(sensor_gain) X(learned_axes) X(learned_gain) X(sensor_curve) \
  X(sensor_hysteresis) X(sensor_lag) X(filter) X(sensor_bias) X(sensor_drift) X(sensor_settling) X(sensor_hum) \
  X(learned_drift) X(deadband) X(clock) X(clipping) X(tare)
// clang-format on

#define HAPSIM_DECLARE_EFFECT(name) const Effect& name##_effect();
HAPSIM_EFFECTS(HAPSIM_DECLARE_EFFECT)
#undef HAPSIM_DECLARE_EFFECT

}  // namespace hapsim
