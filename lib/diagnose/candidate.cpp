#include "diagnose/candidate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "diagnose/held_out.h"
#include "diagnose/offset_test.h"
#include "effects/catalogue.h"
#include "estimate/probability.h"
#include "fit/learned_field.h"
#include "fit/press_offsets.h"
#include "fit/testable.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

constexpr double kMuchLess = 0.9;  // of two errors
constexpr double kNothing = 1e-6;  // rounding alone

// Parameters that the data have to pay for: free ones and offsets solved for press by press.
double parameter_count(const Model& model) {
  double count = static_cast<double>(model.free_parameters().size());
  if (const Effect* effect = offset_effect(model))
    for (const Parameter& p : model.parameters) count += p.effect == effect->card().name;
  return count;
}

// The forces without an effect that is in the fitted model, all else as it is there.
Eigen::VectorXd forces_without(const Effect& effect, const Fit& fitted, const Baseline& base,
                               const TrialGround& g) {
  Model model = fitted.model;
  remove_effect(model, effect.card().name);
  return model_forces(model, g.experiment,
                      g.experiment.places.estimate(material_of(model), base.fitted.about),
                      all_episodes(g.dataset), false)
      .f;
}

// Columns of the new parameters at the candidate's fit, and the finite change of the forces that it
// makes, beside a field with the field as it is then; for effects made from locations one gain a
// position, of which any regions are sums.
Eigen::MatrixXd new_columns(const Effect& effect, const Fit& fitted, const Baseline& base,
                            const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  if (effect.card().is_map || effect.card().is_field) {
    const Eigen::VectorXd f = model_forces(base.fitted, g.experiment, all, false).f;
    Eigen::MatrixXd columns =
        Eigen::MatrixXd::Zero(f.size(), static_cast<Eigen::Index>(g.dataset.positions.size()));
    Eigen::Index at = 0;
    for (const int e : all) {
      const Eigen::Index n = 3 * static_cast<Eigen::Index>(g.dataset.episodes[e].rows.size());
      columns.col(g.dataset.episodes[e].position).segment(at, n) = f.segment(at, n);
      at += n;
    }
    return columns;
  }
  const Signal signal = model_forces(fitted, g.experiment, all, true);
  const std::vector<int> free = fitted.model.free_parameters();
  std::vector<int> chosen;
  for (std::size_t c = 0; c < free.size(); ++c)
    if (fitted.model.parameters[free[c]].effect == effect.card().name)
      chosen.push_back(static_cast<int>(c));
  Eigen::MatrixXd columns(signal.f.size(), static_cast<Eigen::Index>(chosen.size()) + 1);
  columns.leftCols(columns.cols() - 1) = signal.df(Eigen::all, chosen);
  columns.rightCols<1>() = signal.f - (learns_field(base.fitted.model)
                                           ? forces_without(effect, fitted, base, g)
                                           : model_forces(base.fitted, g.experiment, all, false).f);
  return columns;
}

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

// Scores by press of the columns with what the baseline's own parameters can do taken out.
CandidateScores press_scores(Eigen::MatrixXd columns, const Yardstick& y, const TrialGround& g) {
  if (y.offsets) take_out_press_means(g.dataset, all_episodes(g.dataset), columns);
  y.weights.whiten(columns);
  const Eigen::RowVectorXd whole = columns.colwise().norm();
  y.freedom.take_out(columns);
  for (Eigen::Index c = 0; c < columns.cols(); ++c)
    if (columns.col(c).norm() < kNothing * whole[c]) columns.col(c).setZero();
  if (y.jacobian.cols() > 0) {
    const auto qr = y.jacobian.colPivHouseholderQr();
    columns -= y.jacobian * qr.solve(columns);
  }
  CandidateScores scores;
  scores.information = columns.transpose() * columns;
  scores.by_group =
      Eigen::MatrixXd::Zero(columns.cols(), static_cast<Eigen::Index>(g.dataset.episodes.size()));
  Eigen::Index at = 0;
  for (const int e : all_episodes(g.dataset)) {
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(g.dataset.episodes[e].rows.size());
    scores.by_group.col(e) = columns.middleRows(at, n).transpose() * y.residual.segment(at, n);
    at += n;
  }
  return scores;
}

// Of a field, by the places that it was not learned from: each counts as one sample, for what is
// alike within a place is no news, and the fall of its error says how much is foretold.
void measure_by_places(const HeldOut& before, const HeldOut& after, Measured& m) {
  std::vector<double> log_fall;
  for (std::size_t p = 0; p < after.by_place.size(); ++p)
    if (before.by_place[p] > 0 && after.by_place[p] > 0)
      log_fall.push_back(std::log(before.by_place[p] / after.by_place[p]));
  const auto n = static_cast<double>(log_fall.size());
  if (n < 2) return;
  const Eigen::Map<const Eigen::ArrayXd> fall(log_fall.data(),
                                              static_cast<Eigen::Index>(log_fall.size()));
  const double mean = fall.mean();
  const double sd = std::sqrt((fall - mean).square().sum() / (n - 1));
  m.criterion_gain = 2 * n * std::log(before.error.pooled / after.error.pooled);
  m.p_value = m.p_by_size = mean > 0 ? student_two_sided(mean / sd * std::sqrt(n), n - 1) / 2 : 1;
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
  if (card.needs_line && line_left(base.fitted, g.experiment, all).frequency == 0) {
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

Yardstick make_yardstick(const Baseline& base, const std::vector<Candidate>& candidates,
                         const TrialGround& g, bool each_place_free) {
  double best = base.fitted.error.pooled;
  for (const Candidate& c : candidates) best = std::min(best, c.fitted.error.pooled);
  const double noise = std::max(g.allowance.noise, best);
  const Selection all = all_episodes(g.dataset);
  const Signal signal = model_forces(base.fitted, g.experiment, all, true);
  const Weights weights(g.dataset, all, signal.f, noise, g.allowance.floor);
  Yardstick y{weights,
              noise,
              PlaceFreedom(base.fitted, g, signal.f, weights, each_place_free),
              measured_forces(g.dataset, all) - signal.f,
              signal.df,
              {},
              offset_effect(base.fitted.model) != nullptr};
  if (y.offsets) take_out_press_means(g.dataset, all, y.jacobian);
  y.unweighted = y.jacobian;
  y.weights.whiten(y.residual);
  y.weights.whiten(y.jacobian);
  y.freedom.take_out(y.residual);
  y.freedom.take_out(y.jacobian);
  return y;
}

double autocorrelation_time(const Eigen::VectorXd& residual, const TrialGround& g) {
  std::vector<Eigen::Index> lengths;
  for (const Episode& e : g.dataset.episodes)
    lengths.push_back(static_cast<Eigen::Index>(e.rows.size()));
  return autocorrelation_time(residual, lengths);
}

namespace {

// What `column` changes the forces by beyond what the baseline's parameters follow [N^2].
double change_beyond(Eigen::VectorXd column, const Yardstick& y, const TrialGround& g) {
  if (y.offsets) take_out_press_means(g.dataset, all_episodes(g.dataset), column);
  if (y.jacobian.cols() == 0) return column.squaredNorm();
  Eigen::VectorXd whitened = column;
  y.weights.whiten(whitened);
  column -= y.unweighted * y.jacobian.colPivHouseholderQr().solve(whitened);
  return column.squaredNorm();
}

// The change of the forces that an effect must bring [N^2] for the unseen error to fall and for its
// share of the misfit beyond noise to be as large as the gates ask, beside what all else leaves.
double least_change(const Candidate& candidate, const Baseline& base, const TrialGround& g,
                    double count) {
  const Gates gates;
  const double unseen = 1 - gates.held_out_fall, noise = g.allowance.noise;
  double left = candidate.held_out.error.pooled;
  if (!std::isfinite(left)) left = held_out_for(*candidate.effect, base).error.pooled;
  const double rms = candidate.fitted.error.pooled;
  const double beyond = std::max(0.0, rms * rms - noise * noise);
  return count * std::max(gates.share / (1 - gates.share) * beyond,
                          std::isfinite(left) ? left * left * (1 / (unseen * unseen) - 1) : 0.0);
}

}  // namespace

Measured measure(const Candidate& candidate, const Baseline& base, const Yardstick& y,
                 const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  Eigen::VectorXd residual =
      measured_forces(g.dataset, all) - model_forces(candidate.fitted, g.experiment, all, false).f;
  y.weights.whiten(residual);
  y.freedom.take_out(residual);
  Measured m;
  m.memory = autocorrelation_time(residual, g);
  const EffectCard& card = candidate.effect->card();
  if (card.is_field) {
    measure_by_places(base.on_known_map, candidate.held_out, m);
    return m;
  }
  // Which region each position belongs to is chosen by the data as well, and is paid for.
  const double extra = std::max(
      1.0, card.is_map
               ? static_cast<double>(g.dataset.positions.size()) - 1
               : parameter_count(candidate.fitted.model) - parameter_count(base.fitted.model));
  const auto count = static_cast<double>(residual.size());
  const double penalty = extra * std::log(count), before = y.residual.squaredNorm();
  m.criterion_gain = before - residual.squaredNorm() - penalty;
  const double independent = independent_samples(residual, m.memory);
  if (independent > 2 * extra)
    m.p_by_size = fisher_upper((before / residual.squaredNorm() - 1) * independent / extra, extra,
                               independent);
  if (card.per_press) {
    const Eigen::VectorXd f = model_forces(base.fitted, g.experiment, all, false).f;
    const OffsetTest test =
        test_offsets(g.dataset, (measured_forces(g.dataset, all) - f) / y.noise, f);
    m.p_value = test.p_value;
    m.criterion_gain = test.gain - penalty;
    m.explained = test.gain * y.noise * y.noise / count;
    m.smallest_seen = std::sqrt(std::max(y.noise * y.noise * (penalty + Gates().criterion_gain),
                                         least_change(candidate, base, g, count)) /
                                count);
    return m;
  }
  const Eigen::MatrixXd columns = new_columns(*candidate.effect, candidate.fitted, base, g);
  m.scores = press_scores(columns, y, g);
  m.scores.penalty = penalty;
  const double information = m.scores.information(0, 0);
  if (information > 0)
    m.smallest_seen = std::sqrt(
        std::max((penalty + Gates().criterion_gain) / information,
                 least_change(candidate, base, g, count) / change_beyond(columns.col(0), y, g)));
  if (!y.freedom.any()) return m;
  m.hidden = m.scores.information.bottomRightCorner<1, 1>().value() < penalty;
  const Eigen::VectorXd score = m.scores.by_group.rowwise().sum();
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse(m.scores.information);
  m.criterion_gain = score.dot(inverse.solve(score)) - penalty;
  return m;
}

}  // namespace hapsim
