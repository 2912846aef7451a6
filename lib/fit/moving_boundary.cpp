#include "fit/moving_boundary.h"

#include <algorithm>

namespace hapsim {

std::vector<Unknown> ShiftedLines::unknowns() const {
  return std::vector<Unknown>(graph_.size(), {0, -spacing_, spacing_, 0.1 * spacing_, false});
}

MovingBoundary::Blend ShiftedLines::at(const Eigen::Vector2d& p, const Eigen::VectorXd& x,
                                       double width) const {
  const BoundaryGraph::Blend blend = graph_.at(p, x, width);
  Blend result{blend.left, blend.right, blend.share, Eigen::RowVectorXd::Zero(x.size())};
  for (int k = 0; k < 2; ++k)
    result.by[static_cast<Eigen::Index>(blend.key[k])] += blend.by_shift[k];
  return result;
}

void ShiftedLines::known(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
  const double known = 0.5 * spacing_;
  r = x / known;
  J = Eigen::MatrixXd::Identity(x.size(), x.size()) / known;
}

std::vector<Unknown> MovingCurve::unknowns() const {
  std::vector<Unknown> result;
  for (const double value : curve_.theta) result.push_back({value, -20, 20, 0.1, false});
  return result;
}

MovingBoundary::Blend MovingCurve::at(const Eigen::Vector2d& p, const Eigen::VectorXd& x,
                                      double width) const {
  const PlanLevel::Distance distance = curve_.level.distance(p, x);
  const SmoothStep step = smooth_step(distance.value, width);
  return {1, 0, step.value, step.slope * distance.by_theta};
}

void MovingCurve::known(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
  constexpr double kPinned = 0.02;  // by which the mean slope may differ from 1
  const Eigen::Index modes = x.size() - PlanLevel::kPlane;
  r.resize(modes + 1);
  J = Eigen::MatrixXd::Zero(modes + 1, x.size());
  r.head(modes) = x.tail(modes) / curve_.bend;
  J.block(0, PlanLevel::kPlane, modes, modes).diagonal().setConstant(1 / curve_.bend);
  double weight = 1e-12, slope = 0;
  Eigen::RowVectorXd by = Eigen::RowVectorXd::Zero(x.size());
  for (const Eigen::Vector2d& p : places_) {
    const double near = smooth_step(curve_.level.distance(p, x).value, band_).slope * band_;
    if (near <= 0) continue;
    const Eigen::MatrixXd basis = curve_.level.slope(p);
    const Eigen::Vector2d g = basis * x;
    const double steep = std::max(1e-6, g.norm());
    weight += near;
    slope += near * steep;
    by += near / steep * (g.transpose() * basis);
  }
  // The weights are taken for constant in J: it pins a scale that nothing else depends on.
  r[modes] = (slope / weight - 1) / kPinned;
  J.row(modes) = by / (weight * kPinned);
}

}  // namespace hapsim
