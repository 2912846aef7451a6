#include "explore/unseen.h"

#include <algorithm>
#include <cmath>

#include "diagnose/held_out.h"
#include "fit/press_offsets.h"
#include "plan/spacing.h"

namespace hapsim {
namespace {

constexpr int kMostFolds = 20;
constexpr double kEverywhere = 0.05;  // of the largest doubt: none is left where nothing was wrong

}  // namespace

LeftOut places_left_out(const Model& model, const Experiment& experiment,
                        const Allowance& allowance) {
  const Dataset& dataset = experiment.dataset;
  const std::size_t places = dataset.positions.size();
  LeftOut result{{}, {}, allowance.noise};
  if (places < 2) return result;
  const TrialGround ground(experiment, allowance);
  const Selection all = all_episodes(dataset);
  const Fit fitted = fit(model, experiment, all, trial_fit_options(ground));
  const auto forces = [&](const Fit& f) { return model_forces(f, experiment, all, false).f; };
  const Eigen::VectorXd measured = measured_forces(dataset, all), known = forces(fitted);
  const Eigen::VectorXd moved =
      forces(fitted_as_in_folds(fitted, ground, Map::kAnew)) -
      held_out_of(fitted, ground, make_folds(dataset, kMostFolds), Map::kAnew).forces;
  Eigen::VectorXd left = measured - known + moved;
  if (offset_effect(fitted.model) != nullptr) take_out_cross_means(dataset, all, left);
  std::vector<double> components(places, 0);
  result.error = result.force = components;
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    const auto p = static_cast<std::size_t>(e.position);
    const auto n = static_cast<Eigen::Index>(3 * e.rows.size());
    result.error[p] += left.segment(at, n).squaredNorm();
    result.force[p] += measured.segment(at, n).squaredNorm();
    components[p] += static_cast<double>(e.rows.size()) * dataset.axes();
    at += n;
  }
  for (std::size_t p = 0; p < places; ++p) {
    result.error[p] /= components[p];
    result.force[p] /= components[p];
  }
  return result;
}

Unseen unseen_of(const LeftOut& l, const std::vector<double>& shares) {
  double error = 0, force = 0, all = 0;
  for (std::size_t p = 0; p < l.error.size(); ++p) {
    error += shares[p] * l.error[p];
    force += shares[p] * l.force[p];
    all += shares[p];
  }
  return {std::sqrt(error / all) / l.noise,
          std::sqrt(std::max(0.0, error - all * l.noise * l.noise) / force)};
}

std::vector<double> doubt_at(const std::vector<PressablePlace>& places,
                             const std::vector<SeenPlace>& seen, const LeftOut& left_out) {
  std::vector<Vec3> points;
  for (const SeenPlace& place : seen) points.push_back(place.point);
  const double spacing = spacing_of(points);
  std::vector<double> doubt;
  double most = 0;
  for (const PressablePlace& place : places) {
    double sum = 0, weights = 0;
    for (std::size_t p = 0; p < seen.size(); ++p) {
      const double w =
          std::exp(-0.5 * (seen[p].point - place.point).squaredNorm() / (spacing * spacing));
      sum += w * std::max(0.0, left_out.error[p] - left_out.noise * left_out.noise);
      weights += w;
    }
    doubt.push_back(weights > 0 ? sum / weights : 0);
    most = std::max(most, doubt.back());
  }
  for (double& d : doubt) d = most > 0 ? d / most + kEverywhere : 1;
  return doubt;
}

}  // namespace hapsim
