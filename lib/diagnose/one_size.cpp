#include "diagnose/one_size.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/left_over.h"
#include "diagnose/measure.h"
#include "diagnose/search.h"
#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// Which part each stacked component belongs to.
struct Parts {
  const char* name;
  int count = 0;
  std::vector<int> of;
};

std::vector<Parts> parts_of(const Dataset& dataset) {
  constexpr int kBins = 4;
  const Recording& recording = dataset.recording;
  Parts presses{"presses", static_cast<int>(dataset.episodes.size()), {}};
  Parts depths{"depths", kBins, {}}, times{"times since the press began", kBins, {}};
  Parts axes{"axes", 3, {}};
  double deepest = 0;
  for (const Episode& e : dataset.episodes)
    for (const int row : e.rows) deepest = std::max(deepest, recording.u[row].norm());
  int press = 0;
  for (const Episode& e : dataset.episodes) {
    for (std::size_t i = 0; i < e.rows.size(); ++i) {
      const double depth = recording.u[e.rows[i]].norm() / std::max(deepest, 1e-300);
      for (int k = 0; k < 3; ++k) {
        presses.of.push_back(press);
        depths.of.push_back(std::min(kBins - 1, static_cast<int>(kBins * depth)));
        times.of.push_back(static_cast<int>(kBins * i / e.rows.size()));
        axes.of.push_back(k);
      }
    }
    ++press;
  }
  return {presses, depths, times, axes};
}

void take_out(const Eigen::MatrixXd& jacobian, Eigen::MatrixXd& columns) {
  if (jacobian.cols() > 0) columns -= jacobian * jacobian.colPivHouseholderQr().solve(columns);
}

}  // namespace

SizeSpread size_spread(const std::string& effect, const Fit& fitted, const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Signal signal = model_forces(fitted, g.experiment, all, true);
  Model without = fitted.model;
  remove_effect(without, effect);
  const Weights weights(g.dataset, all, signal.f, g.allowance.noise, g.allowance.floor);
  const Eigen::VectorXd change =
      signal.f - model_forces(as_it_is(without, g.experiment), g.experiment, all, false).f;
  Eigen::MatrixXd jacobian = signal.df;
  weights.whiten(jacobian);
  Eigen::VectorXd residual = measured_forces(g.dataset, all) - signal.f;
  weights.whiten(residual);
  std::vector<int> others;
  const std::vector<int> free = fitted.model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c)
    if (fitted.model.parameters[free[c]].effect != effect) others.push_back(static_cast<int>(c));
  const double chance = autocorrelation_time(residual, g) * residual.squaredNorm() /
                        static_cast<double>(residual.size());
  SizeSpread spread;
  for (const Parts& parts : parts_of(g.dataset)) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(residual.size(), parts.count);
    for (Eigen::Index i = 0; i < residual.size(); ++i)
      columns(i, parts.of[static_cast<std::size_t>(i)]) = change[i];
    weights.whiten(columns);
    take_out(jacobian(Eigen::all, others), columns);
    const double size = columns.squaredNorm();
    if (!(size > 0)) continue;
    take_out(jacobian, columns);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    qr.setThreshold(1e-6);
    const Eigen::Index rank = qr.rank();
    const Eigen::VectorXd along = (qr.householderQ().adjoint() * residual).head(rank);
    const double beyond = along.squaredNorm() - static_cast<double>(rank) * chance;
    const double share = std::sqrt(std::max(0.0, beyond) / size);
    if (share > spread.share) spread = {share, parts.name};
  }
  return spread;
}

namespace {

bool claims_a_size(const std::string& effect) {
  const EffectCard& card = require_effect(effect).card();
  return !card.learned && !card.is_map && !card.is_field;
}

std::string words_of(const SizeSpread& spread) {
  return fmt::format("more than noise is left, and its size differs by {:.0f} % between {}",
                     100 * spread.share, spread.among);
}

// The last of the missing effects whose size differs by more than it may: what was found before it
// may differ because of its form.
const Finding* of_other_sizes(const Baseline& base, const TrialGround& g,
                              const std::vector<Finding>& findings, SizeSpread& spread) {
  for (auto f = findings.rbegin(); f != findings.rend(); ++f) {
    if (f->verdict != Verdict::kMissing || !claims_a_size(f->effect) ||
        !base.fitted.model.has(f->effect))
      continue;
    spread = size_spread(f->effect, base.fitted, g);
    if (spread.share > kOneSize) return &*f;
  }
  return nullptr;
}

void doubt_rivals(const TrialGround& g, Diagnosis& d) {
  std::vector<Finding*> rivals;
  for (Finding& f : d.findings)
    if (f.verdict == Verdict::kIndistinguishable) rivals.push_back(&f);
  std::vector<SizeSpread> spreads;
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    const Finding& f = *rivals[k];
    if (k >= d.rivals.size() || !d.rivals[k].has(f.effect) || !claims_a_size(f.effect)) return;
    spreads.push_back(size_spread(f.effect, as_it_is(d.rivals[k], g.experiment), g));
    if (spreads.back().share <= kOneSize) return;
  }
  for (std::size_t k = 0; k < rivals.size(); ++k) doubt(words_of(spreads[k]), *rivals[k]);
  d.rivals.clear();
}

}  // namespace

void doubt(const std::string& why, Finding& f) {
  f.doubted = f.verdict == Verdict::kMissing;
  f.verdict = Verdict::kPossible;
  f.evidence += "; " + why + ": it may stand for another cause";
}

const Finding* outweighed(const Baseline& base, const TrialGround& g,
                          const std::vector<Finding>& findings) {
  const auto square = [](double x) { return x * x; };
  const double left = square(base.fitted.error.pooled) - square(g.allowance.noise);
  for (auto f = findings.rbegin(); f != findings.rend(); ++f) {
    const EffectCard& card = require_effect(f->effect).card();
    if (f->verdict != Verdict::kMissing || card.is_map || card.is_field ||
        !base.fitted.model.has(f->effect))
      continue;
    double taken = 0;
    for (const Finding& term : findings)
      if (term.effect == f->effect && term.verdict == Verdict::kMissing)
        taken += square(term.rmse_now.pooled) - square(term.rmse_after.pooled);
    if (taken < left) return &*f;
  }
  return nullptr;
}

bool doubt_one(Baseline& base, const TrialGround& g, const Folds& folds, Diagnosis& d) {
  const bool ambiguous = !d.rivals.empty();
  const LeftOver left = ambiguous ? d.left : left_over(base.fitted, g);
  if (left.noise_alone() || left.error < kLikeNoise) return false;
  if (ambiguous) {
    doubt_rivals(g, d);
    put_in_order(d.findings);
    return d.rivals.empty();
  }
  SizeSpread spread;
  const Finding* f = outweighed(base, g, d.findings);
  const bool by_weight = f != nullptr;
  if (!by_weight) f = of_other_sizes(base, g, d.findings, spread);
  if (f == nullptr) return false;
  const std::string effect = f->effect;
  const std::string why = by_weight ? "more is left than it takes away" : words_of(spread);
  Baseline without = without_effect(effect, base, g, folds);
  if (!without.fitted.converged) return false;
  base = std::move(without);
  for (Finding& each : d.findings)  // with all of its terms
    if (each.effect == effect && each.verdict == Verdict::kMissing) doubt(why, each);
  put_in_order(d.findings);
  return true;
}

}  // namespace hapsim
