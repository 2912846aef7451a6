#include "diagnose/candidate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnose/held_out.h"
#include "effects/catalogue.h"
#include "fit/learned_field.h"
#include "fit/testable.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

constexpr double kMuchLess = 0.9;  // of two errors

// Whether any start of the effect changes the forces by more than a trace of the noise. A start
// without forces tells nothing; Error(kNoConvergence) when none has any.
bool is_excited(const std::vector<Model>& starts, const Effect& effect, const Baseline& base,
                const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(base.fitted, g.experiment, all, false).f;
  std::size_t without = 0;
  for (const Model& start : starts) {
    Signal signal;
    try {
      const Linearisation about =
          g.experiment.places.estimate(material_of(start), base.fitted.about);
      signal = model_forces(start, g.experiment, about, all, true);
    } catch (const Error& error) {
      if (error.code() != ExitCode::kNoConvergence || ++without == starts.size()) throw;
      continue;
    }
    if ((signal.f - f).norm() > g.allowance.noise) return true;
    const std::vector<int> free = start.free_parameters();
    for (std::size_t c = 0; c < free.size(); ++c) {
      const Parameter& p = start.parameters[free[c]];
      if (p.effect != effect.card().name) continue;
      const double typical = parameter_card(effect, p.name)->scale;
      if (typical * signal.df.col(static_cast<Eigen::Index>(c)).norm() > g.allowance.noise)
        return true;
    }
  }
  return false;
}

// Whether an error of the sensor that runs on in time could be all of the force, without a body: a
// drift, where the force rises at a steady rate and is nowhere zero or held. What it then takes
// away is the body's, however well it foretells.
bool runs_like_the_force(const Model& start, const Effect& effect, const Baseline& base,
                         const TrialGround& g) {
  constexpr double kAlike = 0.05;  // of the force is left; a ball pressed at a steady speed: 0.14
  const EffectCard& card = effect.card();
  if (card.stage != Stage::kSensor || !card.needs_time) return false;
  const Selection all = all_episodes(g.dataset);
  const Signal signal = model_forces(start, g.experiment, base.fitted.about, all, true);
  std::vector<int> own;
  const std::vector<int> free = start.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c)
    if (start.parameters[free[c]].effect == card.name) own.push_back(static_cast<int>(c));
  const Eigen::MatrixXd columns = signal.df(Eigen::all, own);
  const Eigen::VectorXd f = measured_forces(g.dataset, all);
  const Eigen::VectorXd left = f - columns * columns.colPivHouseholderQr().solve(f);
  return left.norm() < kAlike * f.norm();
}

}  // namespace

Baseline make_baseline(const Model& model, const TrialGround& g, const Folds& folds) {
  Baseline base;
  const Selection all = all_episodes(g.dataset);
  base.fitted = fit(model, g.experiment, all, trial_fit_options(g));
  if (folds.held_out.empty()) return base;
  base.held_out = held_out_of(base.fitted, g, folds, Map::kAnew);
  base.on_known_map =
      has_map(base.fitted.model) ? held_out_of(base.fitted, g, folds, Map::kKnown) : base.held_out;
  return base;
}

Baseline without_effect(const std::string& effect, const Baseline& base, const TrialGround& g,
                        const Folds& folds) {
  Model lesser = base.fitted.model;
  remove_effect(lesser, effect);
  return make_baseline(lesser, g, folds);
}

bool worth_a_fit(const Effect& effect, const Baseline& base, const TrialGround& g) {
  constexpr double kShare = 0.5;  // of the price
  const EffectCard& card = effect.card();
  if (!card.screened || !lacking_for(card, g.dataset).empty()) return true;
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(base.fitted, g.experiment, all, false).f;
  const Weights weights(g.dataset, all, f, g.allowance.noise, g.allowance.floor);
  Eigen::VectorXd left = measured_forces(g.dataset, all) - f;
  weights.whiten(left);
  const double price =
      static_cast<double>(card.parameters.size()) * std::log(static_cast<double>(left.size()));
  for (const Model& start :
       with_effect(base.fitted, card.name, g.experiment, all, trial_extend_options(g))) {
    Signal signal;
    try {
      signal = model_forces(start, g.experiment, base.fitted.about, all, true);
    } catch (const Error& error) {  // the fit tells of it
      if (error.code() != ExitCode::kNoConvergence) throw;
      return true;
    }
    Eigen::MatrixXd columns(signal.df.rows(), signal.df.cols() + 1);
    columns << signal.df, signal.f - f;
    weights.whiten(columns);
    const Eigen::VectorXd beside = left - columns * columns.colPivHouseholderQr().solve(left);
    if (left.squaredNorm() - beside.squaredNorm() > kShare * price) return true;
  }
  return false;
}

std::optional<Candidate> try_effect(const Effect& effect, const Baseline& base,
                                    const TrialGround& g, std::string& lack) {
  const EffectCard& card = effect.card();
  lack = lacking_for(card, g.dataset);
  if (!lack.empty()) return std::nullopt;
  const Selection all = all_episodes(g.dataset);
  if (card.needs_line && line_left(base.fitted, g.experiment, all, card.stage).frequency == 0) {
    lack = kNoLine;
    return std::nullopt;
  }
  const Model& model = base.fitted.model;
  if (card.is_map && g.experiment.places.has_labels(material_of(model))) {
    lack =
        "the model's regions are those of the body's tetrahedra: take out their moduli to try a "
        "map over the surface";
    return std::nullopt;
  }
  Candidate candidate;
  candidate.effect = &effect;
  candidate.one_more_term = model.has(card.name);
  const std::vector<Model> starts =
      with_effect(base.fitted, card.name, g.experiment, all, trial_extend_options(g));
  try {
    if (!card.per_press && !card.is_map && !card.is_field && !is_excited(starts, effect, base, g)) {
      lack = "nothing in these presses depends on it; record " + card.separated_by;
      return std::nullopt;
    }
    if (runs_like_the_force(starts.front(), effect, base, g)) {
      lack = "the force itself runs like it in time; record air before and after, or a hold";
      return std::nullopt;
    }
    // Estimates; refine() solves where that is promising.
    candidate.fitted =
        fit_best(starts, g.experiment, all, trial_fit_options(g, 0), base.fitted.about);
    if (card.solved) candidate.starts = starts;
  } catch (const Error& error) {
    if (error.code() != ExitCode::kNoConvergence) throw;
    lack = std::string("it cannot be fitted: ") + error.what();
    return std::nullopt;
  }
  return candidate;
}

void refine(Candidate& candidate, const TrialGround& g) {
  const EffectCard& card = candidate.effect->card();
  const Selection all = all_episodes(g.dataset);
  if (card.solved)
    candidate.fitted = fit_solved(candidate.fitted.model, candidate.starts, g.experiment, all,
                                  trial_fit_options(g));
  else if (card.is_map)
    candidate.fitted = fit(candidate.fitted.model, g.experiment, all, trial_fit_options(g));
}

void hold_out(Candidate& candidate, const TrialGround& g, const Folds& folds) {
  if (folds.held_out.empty()) return;
  const Map map = candidate.effect->card().is_map ? Map::kAnew : Map::kKnown;
  candidate.held_out = held_out_of(candidate.fitted, g, folds, map);
}

void prefer_sites(Candidate& candidate, const Baseline& base, const TrialGround& g,
                  const Folds& folds) {
  // A field that is learned foretells such places better.
  if (!candidate.effect->card().is_map || folds.held_out.empty() ||
      lacking_for(field_effect().card(), g.dataset).empty())
    return;
  ExtendOptions options = trial_extend_options(g);
  options.regions = kEverySite;
  Candidate sites = candidate;
  sites.every_site = true;
  const Selection all = all_episodes(g.dataset);
  sites.fitted =
      fit_best(with_effect(base.fitted, candidate.effect->card().name, g.experiment, all, options),
               g.experiment, all, trial_fit_options(g, 0), base.fitted.about);
  hold_out(sites, g, folds);
  // Between pressed places a boundary may lie anywhere and errs there, but one that leaves the
  // pressed ones noise alone is there.
  const bool proven = candidate.fitted.error.pooled < kLikeNoise * g.allowance.noise &&
                      candidate.fitted.error.pooled < kMuchLess * sites.fitted.error.pooled;
  if (!proven && sites.held_out.error.pooled < kMuchLess * candidate.held_out.error.pooled)
    candidate = std::move(sites);
}

}  // namespace hapsim
