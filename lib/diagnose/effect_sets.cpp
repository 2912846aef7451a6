#include "diagnose/effect_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/departures.h"
#include "diagnose/measure.h"
#include "effects/catalogue.h"

namespace hapsim {
EffectNames with(EffectNames names, const std::string& name) {
  names.insert(std::upper_bound(names.begin(), names.end(), name), name);
  return names;
}

EffectNames without(EffectNames names, const std::string& name) {
  names.erase(std::find(names.begin(), names.end(), name));
  return names;
}

bool needs_many_presses(const EffectCard& card) {
  return card.per_press || card.is_map || card.among_presses;
}

EffectSets::EffectSets(const Baseline& base, const TrialGround& g, const DiagnoseOptions& options)
    : ground_(g), options_(options), departs_(stiffness_departures(base.fitted, g).anywhere()) {
  keep({}, base.fitted);
}

const EffectSet* EffectSets::grown(const EffectSet& from, const Effect& effect) {
  const EffectNames names = with(from.added, effect.card().name);
  if (const auto known = all_.find(names); known != all_.end()) return &known->second;
  if (refused_.count(names) > 0) return nullptr;
  options_.tell("testing " + effect.card().name);
  if (!worth_a_fit(effect, {from.fitted, {}, {}}, ground_)) {
    refused_[names] = kTakesNothing;
    return nullptr;
  }
  std::string lack;
  auto candidate = try_effect(effect, {from.fitted, {}, {}}, ground_, lack);
  if (candidate) {
    refine(*candidate, ground_);
    lack = implausible(candidate->fitted.model, effect, ground_.dataset);
    if (lack.empty()) lack = unlike_a_sensor(candidate->fitted, effect);
    if (lack.empty()) return keep(names, candidate->fitted);
  } else if (from.added.empty()) {
    lack_[effect.card().name] = lack;
  }
  refused_[names] = lack;
  return nullptr;
}

std::string EffectSets::refusal(const EffectSet& from, const Effect& effect) const {
  return refused_.at(with(from.added, effect.card().name));
}

const EffectSet* EffectSets::find(const EffectNames& names) {
  if (const auto known = all_.find(names); known != all_.end()) return &known->second;
  if (refused_.count(names) > 0) return nullptr;
  for (const std::string& name : names)
    if (const EffectSet* smaller = find(without(names, name)))
      if (const EffectSet* set = grown(*smaller, require_effect(name))) return set;
  refused_.emplace(names, "");
  return nullptr;
}

const EffectSet* EffectSets::find_below(EffectNames names) {
  for (; !names.empty(); names.pop_back())
    if (const EffectSet* set = find(names)) return set;
  return find({});
}

std::vector<const Effect*> EffectSets::growth(const EffectSet& from, Kind kind) const {
  std::vector<const Effect*> effects = untried(from.fitted.model, kind, options_.unknown);
  std::erase_if(effects, [&](const Effect* e) {
    const EffectCard& card = e->card();
    return needs_many_presses(card) || (card.solved && !departs_) || lack_.count(card.name) > 0;
  });
  return effects;
}

double EffectSets::criterion(const EffectSet& set) const {
  Eigen::VectorXd r = set.residual;
  Weights(ground_.dataset, all_episodes(ground_.dataset),
          measured_forces(ground_.dataset, all_episodes(ground_.dataset)),
          std::max(ground_.allowance.noise, least_->fitted.error.pooled), ground_.allowance.floor)
      .whiten(r);
  return information_criterion(r.squaredNorm(), memory_, independent_, set.parameters);
}

// One press cannot tell a sensor that is not straight from a material that stiffens, but a sensor
// is a sensor.
std::string EffectSets::unlike_a_sensor(const Fit& fitted, const Effect& effect) const {
  const double most = effect.card().most_bend;
  if (most <= 0) return "";
  Fit straight = fitted;
  std::erase_if(straight.model.parameters,
                [&](const Parameter& p) { return p.effect == effect.card().name; });
  const Selection all = all_episodes(ground_.dataset);
  const Eigen::VectorXd f = model_forces(fitted, ground_.experiment, all, false).f;
  const Eigen::VectorXd g = model_forces(straight, ground_.experiment, all, false).f;
  // Off the straight line from nothing to the largest force (terminal-based linearity).
  const double full = f.cwiseAbs().maxCoeff();
  const double gain = full / g.cwiseAbs().maxCoeff();
  const double bend = (f - gain * g).cwiseAbs().maxCoeff() / full;
  if (bend < most) return "";
  return fmt::format(
      "a force sensor that is {:.0f} % of its reading off a straight line is none: "
      "a material or a contact that stiffens does that",
      100 * bend);
}

const EffectSet* EffectSets::keep(const EffectNames& names, const Fit& fitted) {
  const Selection all = all_episodes(ground_.dataset);
  EffectSet set{names, fitted,
                measured_forces(ground_.dataset, all) -
                    model_forces(fitted, ground_.experiment, all, false).f,
                fitted.model.free_parameters().size()};
  const EffectSet* kept = &all_.emplace(names, std::move(set)).first->second;
  if (least_ == nullptr || fitted.error.pooled < least_->fitted.error.pooled) {
    least_ = kept;
    memory_ = autocorrelation_time(kept->residual, ground_);
    independent_ = independent_samples(kept->residual, memory_);
  }
  return kept;
}

}  // namespace hapsim
