#include "diagnose/effect_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/departures.h"
#include "diagnose/try_effects.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr double kCrookedest = 0.05;  // force sensor, of its range; the worst on sale are at 0.01

}  // namespace

EffectNames with(EffectNames names, const std::string& name) {
  names.insert(std::upper_bound(names.begin(), names.end(), name), name);
  return names;
}

EffectNames without(EffectNames names, const std::string& name) {
  names.erase(std::find(names.begin(), names.end(), name));
  return names;
}

bool needs_many_presses(const EffectCard& card) {
  return card.by_press || card.from_locations;
}

void solve_body_of(const EffectSet& set, Workspace& w) {
  w.body->solve(material_of(set.fitted.model));
}

EffectSets::EffectSets(const Baseline& base, Workspace& w, const DiagnoseOptions& options)
    : w_(w), options_(options), departs_(stiffness_departures(base.fitted.model, w).anywhere()) {
  keep({}, base.fitted);
}

const EffectSet* EffectSets::grown(const EffectSet& from, const Effect& effect) {
  const EffectNames names = with(from.added, effect.card().name);
  if (const auto known = all_.find(names); known != all_.end()) return &known->second;
  if (refused_.count(names) > 0) return nullptr;
  if (options_.progress) options_.progress(effect.card().name);
  std::string lack;
  solve_body_of(from, w_);
  auto candidate = try_effect(effect, {from.fitted, {}}, w_, lack);
  if (candidate) {
    refine(*candidate, w_);
    lack = implausible(candidate->fitted.model, effect, w_.dataset);
    if (lack.empty()) lack = unlike_a_sensor(candidate->fitted.model, effect);
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

std::vector<const Effect*> EffectSets::growth(const EffectSet& from) const {
  std::vector<const Effect*> effects = untried(from.fitted.model);
  std::erase_if(effects, [&](const Effect* e) {
    const EffectCard& card = e->card();
    return needs_many_presses(card) || (card.solved && !departs_) || lack_.count(card.name) > 0;
  });
  return effects;
}

double EffectSets::criterion(const EffectSet& set) const {
  Eigen::VectorXd r = set.residual;
  Weights(w_.dataset, all_episodes(w_.dataset),
          measured_forces(w_.dataset, all_episodes(w_.dataset)),
          std::max(w_.noise.value, least_->fitted.rmse), w_.floor)
      .whiten(r);
  return information_criterion(r.squaredNorm(), memory_, independent_, set.parameters);
}

// One press cannot tell a sensor that is not straight from a material that stiffens, but a sensor
// is a sensor.
std::string EffectSets::unlike_a_sensor(const Model& model, const Effect& effect) const {
  if (effect.card().name != "sensor-curve") return "";
  Model straight = model;
  std::erase_if(straight.parameters,
                [&](const Parameter& p) { return p.effect == effect.card().name; });
  const Selection all = all_episodes(w_.dataset);
  const Eigen::VectorXd f = model_forces(model, w_.dataset, all, *w_.body, false).f;
  const Eigen::VectorXd g = model_forces(straight, w_.dataset, all, *w_.body, false).f;
  // Off the straight line from nothing to the largest force (terminal-based linearity).
  const double full = f.cwiseAbs().maxCoeff();
  const double gain = full / g.cwiseAbs().maxCoeff();
  const double bend = (f - gain * g).cwiseAbs().maxCoeff() / full;
  if (bend < kCrookedest) return "";
  return fmt::format(
      "a force sensor that is {:.0f} % of its reading off a straight line is none: "
      "a material or a contact that stiffens does that",
      100 * bend);
}

const EffectSet* EffectSets::keep(const EffectNames& names, const FitResult& fitted) {
  const Selection all = all_episodes(w_.dataset);
  EffectSet set{names, fitted,
                measured_forces(w_.dataset, all) -
                    model_forces(fitted.model, w_.dataset, all, *w_.body, false).f,
                fitted.model.free_parameters().size()};
  const EffectSet* kept = &all_.emplace(names, std::move(set)).first->second;
  singles_ += names.size() == 1;
  if (least_ == nullptr || fitted.rmse < least_->fitted.rmse) {
    least_ = kept;
    memory_ = autocorrelation_time(kept->residual, w_);
    independent_ = independent_samples(kept->residual, memory_);
  }
  return kept;
}

}  // namespace hapsim
