#include <algorithm>
#include <cmath>

#include "fit/fit.h"
#include "fit/learned_field.h"
#include "fit/press_offsets.h"

namespace hapsim {

Folds make_folds(const Dataset& dataset, int count) {
  Folds folds;
  const bool by_position = dataset.positions.size() > 1;
  const std::size_t groups = by_position ? dataset.positions.size() : dataset.episodes.size();
  if (groups < 2 || count < 2) return folds;
  folds.by = by_position ? "positions" : "presses";
  folds.held_out.resize(std::min<std::size_t>(groups, static_cast<std::size_t>(count)));
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e) {
    const std::size_t group =
        by_position ? static_cast<std::size_t>(dataset.episodes[e].position) : e;
    folds.held_out[group % folds.held_out.size()].push_back(static_cast<int>(e));
  }
  return folds;
}

Folds make_press_folds(const Dataset& dataset, int count) {
  Folds folds{std::vector<Selection>(static_cast<std::size_t>(count)), "presses"};
  std::vector<std::size_t> presses(dataset.positions.size(), 0);
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e) {
    const auto p = static_cast<std::size_t>(dataset.episodes[e].position);
    folds.held_out[(p + presses[p]++) % folds.held_out.size()].push_back(static_cast<int>(e));
  }
  std::erase_if(folds.held_out, [](const Selection& part) { return part.empty(); });
  if (folds.held_out.size() < 2) folds.held_out.clear();
  return folds;
}

HeldOut held_out_error(const ModelBuilder& builder, const Experiment& experiment,
                       const Folds& folds, const FitOptions& options) {
  const Dataset& dataset = experiment.dataset;
  HeldOut result;
  result.error.axes = dataset.axes();
  result.by_place.assign(dataset.positions.size(), 0);
  FitOptions about = options;
  about.rounds = 0;
  about.keep_scales = false;
  about.keep = nullptr;
  double squares = 0, components = 0;
  for (const Selection& held_out : folds.held_out) {
    Selection training;
    for (const int e : all_episodes(dataset))
      if (std::find(held_out.begin(), held_out.end(), e) == held_out.end()) training.push_back(e);
    Starts starts = builder(training);
    // What a field has learned of the places left out is not to be known.
    for (Model& start : starts.models) forget_field(start);
    const Fit fitted = fit_best(starts.models, experiment, training, about, starts.known);
    Eigen::VectorXd r =
        measured_forces(dataset, held_out) - model_forces(fitted, experiment, held_out, false).f;
    if (offset_effect(fitted.model) != nullptr) take_out_cross_means(dataset, held_out, r);
    Eigen::Index at = 0;
    for (const int e : held_out) {
      const Episode& episode = dataset.episodes[static_cast<std::size_t>(e)];
      const auto n = static_cast<Eigen::Index>(3 * episode.rows.size());
      result.by_place[static_cast<std::size_t>(episode.position)] += r.segment(at, n).squaredNorm();
      at += n;
    }
    result.squares.push_back(r.squaredNorm());
    result.components.push_back(static_cast<double>(r.size()));
    squares += result.squares.back();
    components += result.components.back();
  }
  if (components > 0) result.error.pooled = std::sqrt(squares / components);
  return result;
}

}  // namespace hapsim
