// A spherical tip sample by sample: private to the effect `tip`.
#pragma once

#include <memory>

#include "effects/effect_step.h"

namespace hapsim::tip {

// `kappa` above 0.
std::unique_ptr<EffectStep> make_step(double kappa, double radius);

}  // namespace hapsim::tip
