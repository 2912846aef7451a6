#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/parallel.h"
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

namespace {

// What one fold says.
struct HeldOutPart {
  double squares = 0;            // [N^2]
  double components = 0;         // 3 x rows
  std::vector<double> by_press;  // sum of squares [N^2], in the order of the fold
  Eigen::VectorXd forces;        // foretold [N], in that order
};

// A watch that several fits ask at once: only the thread that made it asks what it stands for,
// which may speak to a terminal or to an interpreter; the others hear what that said last.
std::function<bool(const FitProgress&)> heard_by_all(
    std::function<bool(const FitProgress&)> watch) {
  if (!watch) return watch;
  auto goes_on = std::make_shared<std::atomic<bool>>(true);
  return [watch = std::move(watch), goes_on,
          own = std::this_thread::get_id()](const FitProgress& progress) {
    if (std::this_thread::get_id() == own && !watch(progress)) *goes_on = false;
    return goes_on->load();
  };
}

HeldOutPart held_out_part(const ModelBuilder& builder, const Experiment& experiment,
                          const Selection& held_out, const FitOptions& about) {
  const Dataset& dataset = experiment.dataset;
  Selection training;
  for (const int e : all_episodes(dataset))
    if (std::find(held_out.begin(), held_out.end(), e) == held_out.end()) training.push_back(e);
  Starts starts = builder(training);
  // What a field has learned of the places left out is not to be known.
  for (Model& start : starts.models) forget_field(start);
  Eigen::VectorXd r = measured_forces(dataset, held_out), forces = Eigen::VectorXd::Zero(r.size());
  try {
    const Fit fitted = fit_best(starts.models, experiment, training, about, starts.known);
    forces = model_forces(fitted, experiment, held_out, false).f;
    r -= forces;
    if (offset_effect(fitted.model) != nullptr) take_out_cross_means(dataset, held_out, r);
  } catch (const Error& error) {  // a law without an equilibrium there foretells nothing
    if (error.code() != ExitCode::kNoConvergence) throw;
  }
  HeldOutPart part{r.squaredNorm(), static_cast<double>(r.size()), {}, forces};
  Eigen::Index at = 0;
  for (const int e : held_out) {
    const auto n =
        static_cast<Eigen::Index>(3 * dataset.episodes[static_cast<std::size_t>(e)].rows.size());
    part.by_press.push_back(r.segment(at, n).squaredNorm());
    at += n;
  }
  return part;
}

// Where each episode's forces begin among those of all, stacked; and their end.
std::vector<Eigen::Index> first_components(const Dataset& dataset) {
  std::vector<Eigen::Index> first{0};
  for (const Episode& e : dataset.episodes)
    first.push_back(first.back() + static_cast<Eigen::Index>(3 * e.rows.size()));
  return first;
}

}  // namespace

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
  about.watch = heard_by_all(options.watch);
  std::vector<HeldOutPart> parts(folds.held_out.size());
  in_parallel(parts.size(), experiment.places.threads(), [&](std::size_t k) {
    parts[k] = held_out_part(builder, experiment, folds.held_out[k], about);
  });
  double squares = 0, components = 0;
  const std::vector<Eigen::Index> row = first_components(dataset);
  result.forces.setConstant(row.back(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < parts[k].by_press.size(); ++i) {
      const auto e = static_cast<std::size_t>(folds.held_out[k][i]);
      result.by_place[static_cast<std::size_t>(dataset.episodes[e].position)] +=
          parts[k].by_press[i];
      const Eigen::Index n = row[e + 1] - row[e];
      result.forces.segment(row[e], n) = parts[k].forces.segment(at, n);
      at += n;
    }
    result.squares.push_back(parts[k].squares);
    result.components.push_back(parts[k].components);
    squares += parts[k].squares;
    components += parts[k].components;
  }
  if (components > 0) result.error.pooled = std::sqrt(squares / components);
  return result;
}

}  // namespace hapsim
