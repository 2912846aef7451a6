#include "fit/forecasts.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "effects/catalogue.h"
#include "fit/extend.h"
#include "fit/testable.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

// What the effect is can be found again from its own starts.
bool is_learned_anew(const EffectCard& card, const Model& model, const Dataset& dataset) {
  if (card.is_map || card.is_field || card.per_press || card.solved) return false;
  return lacking_for(card, dataset).empty() &&
         std::any_of(model.parameters.begin(), model.parameters.end(), [&](const Parameter& p) {
           return p.effect == card.name && p.state == ParameterState::kFree;
         });
}

}  // namespace

Forecasts::Forecasts(const Fit& fitted, const Experiment& experiment, std::vector<UnseenPart> parts,
                     const FitOptions& options)
    : experiment_(experiment),
      parts_(std::move(parts)),
      options_(options),
      model_(fitted.model),
      bare_(fitted.model),
      about_(fitted.about),
      measured_(measured_forces(experiment.dataset, all_episodes(experiment.dataset))),
      learned_(parts_.size()) {
  options_.rounds = 0;
  options_.keep = nullptr;
  for (const std::string& name : model_.effects()) {
    const Effect& effect = require_effect(name);
    if (&effect == &body_effect() || !is_learned_anew(effect.card(), model_, experiment.dataset))
      continue;
    const auto rows = std::count_if(model_.parameters.begin(), model_.parameters.end(),
                                    [&](const Parameter& p) { return p.effect == name; });
    const auto terms = effect.card().terms
                           ? static_cast<std::size_t>(rows) / effect.card().parameters.size()
                           : std::size_t{1};
    own_.insert(own_.end(), terms, name);
    std::erase_if(bare_.parameters, [&](const Parameter& p) { return p.effect == name; });
  }
  std::sort(own_.begin(), own_.end());
}

const std::vector<Eigen::VectorXd>& Forecasts::left(const Names& added) {
  if (const auto known = left_.find(added); known != left_.end()) return known->second;
  const Selection all = all_episodes(experiment_.dataset);
  std::vector<Eigen::VectorXd> left(parts_.size());
  in_parallel(parts_.size(), experiment_.places.threads(), [&](std::size_t d) {
    Eigen::VectorXd r = measured_;
    try {
      r -= model_forces(learned(d, own_, added), experiment_, all, false).f;
    } catch (const Error& error) {  // a law without an equilibrium there foretells nothing
      if (error.code() != ExitCode::kNoConvergence) throw;
    }
    const std::vector<Eigen::Index>& rows = parts_[d].rows;
    Eigen::VectorXd unseen(3 * static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i)
      unseen.segment<3>(3 * static_cast<Eigen::Index>(i)) = r.segment<3>(3 * rows[i]);
    left[d] = std::move(unseen);
  });
  return left_.emplace(added, std::move(left)).first->second;
}

Fit Forecasts::learn_bare(const UnseenPart& part) const {
  Model start = bare_;
  try {
    const Model elastic = elastic_model(part.known, part.seen);
    const bool one_region = std::all_of(start.parameters.begin(), start.parameters.end(),
                                        [](const Parameter& p) { return p.region == 0; });
    for (Parameter& p : start.parameters) {
      if (!one_region || p.effect != body_effect().card().name) continue;
      if (const Parameter* first = elastic.find(p.effect, p.region, p.name);
          first != nullptr && p.state == ParameterState::kFree)
        p.value = std::clamp(first->value, p.lower, p.upper);
    }
  } catch (const Error& error) {  // the known rows do not press the body
    if (error.code() != ExitCode::kBadInput) throw;
  }
  return fit(start, part.known, part.seen, options_, about_);
}

bool Forecasts::learn_more(const Fit& smaller, const std::string& effect, const UnseenPart& part,
                           Fit& more) const {
  ExtendOptions extend;
  extend.noise = options_.noise;
  extend.floor = options_.floor;
  try {
    std::vector<Model> starts = with_effect(smaller, effect, part.known, part.seen, extend);
    for (Model& start : starts)
      for (const Parameter& given : model_.parameters)
        if (Parameter* p = start.find(given.effect, given.region, given.name);
            p != nullptr && given.state == ParameterState::kFixed)
          *p = given;
    more = fit_best(starts, part.known, part.seen, options_, smaller.about);
    return true;
  } catch (const Error& error) {
    if (error.code() == ExitCode::kIo) throw;
    return false;
  }
}

const Fit& Forecasts::learned(std::size_t part, const Names& own, const Names& added) {
  Names names = own;
  names.insert(names.end(), added.begin(), added.end());
  std::map<Names, Fit>& known = learned_[part];
  if (const auto found = known.find(names); found != known.end()) return found->second;
  if (names.empty()) return known.emplace(names, learn_bare(parts_[part])).first->second;
  const Names& last = added.empty() ? own : added;
  const Fit* stays = nullptr;  // the best of the smaller sets, where none can be extended
  Fit best;
  bool found = false;
  for (std::size_t i = 0; i < last.size(); ++i) {
    if (i > 0 && last[i] == last[i - 1]) continue;
    Names rest = last;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    const Fit& smaller = added.empty() ? learned(part, rest, added) : learned(part, own, rest);
    if (stays == nullptr || smaller.error.pooled < stays->error.pooled) stays = &smaller;
    Fit more;
    if (!learn_more(smaller, last[i], parts_[part], more)) continue;
    if (!found || more.error.pooled < best.error.pooled) best = std::move(more);
    found = true;
  }
  return known.emplace(names, found ? best : *stays).first->second;
}

}  // namespace hapsim
