// Sets of effects on top of a model, for a diagnosis that grows them side by side.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/candidate.h"
#include "diagnose/try_effects.h"

namespace hapsim {

using EffectNames = std::vector<std::string>;  // sorted; a name twice is a term more

struct EffectSet {
  EffectNames added;
  Fit fitted;
  Eigen::VectorXd residual;  // [N]
  std::size_t parameters = 0;
};

EffectNames with(EffectNames names, const std::string& name);
EffectNames without(EffectNames names, const std::string& name);
// Whether an effect is told by comparing presses.
bool needs_many_presses(const EffectCard& card);

// Each set is fitted once, when it is first asked for. Pointers stay valid.
class EffectSets {
 public:
  EffectSets(const Baseline& base, const TrialGround& ground, const DiagnoseOptions& options);

  // Nothing when the effect cannot be seen there or comes out implausible; refusal() says why.
  const EffectSet* grown(const EffectSet& from, const Effect& effect);
  std::string refusal(const EffectSet& from, const Effect& effect) const;
  // The set of these names, grown one by one in any order; nothing when none of them leads there.
  const EffectSet* find(const EffectNames& names);
  // That set, or the largest below it that there is.
  const EffectSet* find_below(EffectNames names);
  // What could be added to a set here.
  std::vector<const Effect*> growth(const EffectSet& from, Kind kind) const;

  // The set's chi-square plus log n a parameter; what the best set leaves is the unit of both.
  double criterion(const EffectSet& set) const;
  // Effects that these data cannot test on top of the model alone, and why.
  const std::map<std::string, std::string>& lack() const { return lack_; }
  bool departs() const { return departs_; }  // some position asks for another stiffness

 private:
  const EffectSet* keep(const EffectNames& names, const Fit& fitted);
  std::string unlike_a_sensor(const Fit& fitted, const Effect& effect) const;

  const TrialGround& ground_;
  const DiagnoseOptions& options_;
  bool departs_;
  std::map<EffectNames, EffectSet> all_;
  std::map<EffectNames, std::string> refused_;
  std::map<std::string, std::string> lack_;
  const EffectSet* least_ = nullptr;  // that errs least
  double memory_ = 1, independent_ = 1;
};

}  // namespace hapsim
