// The exponential memory of one Maxwell element, exact for inputs that are straight between
// samples.
#pragma once

#include <cmath>

namespace hapsim {

// h_{k+1} = a h_k + c (x_{k+1} - x_k) with a = exp(-dt/tau), c = (tau/dt)(1 - a): thesis
// (3.54)-(3.55).
struct MemoryStep {
  double a = 1, c = 1;  // limits for dt = 0: a jump
  double da_dtau = 0, dc_dtau = 0;
};

inline MemoryStep memory_step(double dt, double tau) {
  MemoryStep step;
  if (dt <= 0) return step;
  const double ratio = dt / tau;
  step.a = std::exp(-ratio);
  const double lost = -std::expm1(-ratio);  // 1 - a without cancellation
  step.c = lost / ratio;
  step.da_dtau = step.a * ratio / tau;
  // (1 - a)/dt - a/tau cancels for short steps, where its series is ratio / (2 tau).
  step.dc_dtau = ratio < 1e-4 ? (0.5 * ratio - ratio * ratio / 3) / tau : (step.c - step.a) / tau;
  return step;
}

}  // namespace hapsim
