#include "fit/boundary_error.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "fit/press_offsets.h"
#include "model/body_parameters.h"

namespace hapsim {

void add_boundary_error(Fit& fitted, const Experiment& experiment, const Eigen::MatrixXd& by_shift,
                        const Eigen::MatrixXd& covariance) {
  const Selection all = all_episodes(experiment.dataset);
  const std::vector<int> free = fitted.model.free_parameters();
  std::vector<Eigen::Index> told;
  for (std::size_t c = 0; c < free.size(); ++c)
    if (std::isfinite(fitted.model.parameters[free[c]].std_error))
      told.push_back(static_cast<Eigen::Index>(c));
  if (told.empty()) return;
  Eigen::MatrixXd F = model_forces(fitted, experiment, all, true).df(Eigen::all, told);
  Eigen::MatrixXd B = by_shift;
  if (offset_effect(fitted.model) != nullptr) {
    take_out_press_means(experiment.dataset, all, F);
    take_out_press_means(experiment.dataset, all, B);
  }
  const Eigen::VectorXd scale =
      F.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
  F = F * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd D =
      scale.cwiseInverse().asDiagonal() * F.colPivHouseholderQr().solve(-B).eval();
  for (std::size_t k = 0; k < told.size(); ++k) {
    Parameter& p = fitted.model.parameters[free[static_cast<std::size_t>(told[k])]];
    const auto row = D.row(static_cast<Eigen::Index>(k));
    p.std_error = std::sqrt(p.std_error * p.std_error +
                            std::max(0.0, (row * covariance * row.transpose()).value()));
  }
}

void tell_key_point_errors(Model& model, const std::vector<BoundaryLine>& lines,
                           const std::vector<double>& error) {
  std::vector<Eigen::Vector2d> points;
  for (const BoundaryLine& line : lines) {
    const bool closed = (line.points.front() - line.points.back()).norm() < 1e-9;
    points.insert(points.end(), line.points.begin(), line.points.end() - (closed ? 1 : 0));
  }
  for (Parameter& x : model.parameters) {
    if (!is_of_map(x) || x.name.front() != 'x') continue;
    Parameter* y = model.find(x.effect, x.region, "y" + x.name.substr(1));
    const Eigen::Vector2d here(x.value, y->value);
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < std::min(points.size(), error.size()); ++k)
      if ((points[k] - here).norm() < (points[nearest] - here).norm()) nearest = k;
    const Eigen::Vector2d across = (here - points[nearest]).stableNormalized();
    x.std_error = error[nearest] * std::abs(across.x());
    y->std_error = error[nearest] * std::abs(across.y());
  }
}

}  // namespace hapsim
