// A sum of exponential memories of the force before it, as batch and sample by sample: what every
// law of relaxation comes down to.
#pragma once

#include <utility>
#include <vector>

#include "effects/effect_step.h"
#include "material/maxwell_memory.h"

namespace hapsim {

// One memory: its share of the force and its time [s], and their derivatives by columns.
struct MemoryTerm {
  double share = 0, tau = 1;
  std::vector<std::pair<int, double>> share_by, tau_by;
};

// Adds sum_i share_i h_i, dh_i/dt = dg/dt - h_i/tau_i, to the signal: g is `driver`, a signal of
// the same samples and columns, straight between samples and at rest before the first. Without
// press.t it does nothing.
void add_memory(const PressView& press, const std::vector<MemoryTerm>& terms, const Signal& driver,
                Signal& signal);

// The same sample by sample, in memory of size() numbers: the driver, then the memories. With
// `first` the body was at rest until now.
class MemorySteps {
 public:
  explicit MemorySteps(std::vector<MaxwellTerm> terms)
      : terms_(std::move(terms)), decay_(terms_.size()) {}
  std::size_t size() const { return 3 + 3 * terms_.size(); }
  void add(const StepSample& sample, const Vec3& driver, double* memory, Vec3& f) noexcept;

 private:
  std::vector<MaxwellTerm> terms_;
  std::vector<MemoryStep> decay_;  // of a step of dt_ at times_, most steps being as the last one
  double dt_ = -1, times_ = 1;
};

// The step of an effect that is nothing but memories of the force before it.
std::unique_ptr<EffectStep> memory_effect_step(std::vector<MaxwellTerm> terms);

// Terms without derivatives.
std::vector<MaxwellTerm> plain_terms(const std::vector<MemoryTerm>& terms);

}  // namespace hapsim
