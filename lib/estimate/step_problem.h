// The problem that one step of minimise_under() solves: private to lib/estimate.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "estimate/ipopt.h"
#include "estimate/stepped_constraint.h"

namespace hapsim {

// A step of the unknowns that can move: |R d + q|^2 + d'S d, d = y - about, under the constraints.
// Ipopt is told of the squares alone.
class StepProblem : public IpoptProblemOf {
 public:
  StepProblem(const std::vector<SmoothConstraint>& constraints, const Coordinates& coordinates,
              std::vector<Eigen::Index> open, Eigen::VectorXd all)
      : constraints_(constraints),
        coordinates_(coordinates),
        open_(std::move(open)),
        all_(std::move(all)) {
    least = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(constraints.size()));
    most = least;
    for (std::size_t c = 0; c < constraints.size(); ++c)
      if (!constraints[c].equality) most[static_cast<Eigen::Index>(c)] = 1e300;
    // Of one size, whatever their units.
    for (const SmoothConstraint& c : constraints) {
      const double slope = in_steps(c, coordinates_, all_).slope.norm();
      weight_.push_back(std::isfinite(slope) && slope > 0 ? 1 / slope : 1);
    }
  }
  Eigen::VectorXd inner() const {
    Eigen::VectorXd at(static_cast<Eigen::Index>(open_.size()));
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      const Eigen::Index i = open_[static_cast<std::size_t>(k)];
      at[k] = coordinates_.inner(static_cast<std::size_t>(i), all_[i]);
    }
    return at;
  }
  Eigen::VectorXd outer(const Eigen::VectorXd& at) const {
    Eigen::VectorXd x = all_;
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      const Eigen::Index i = open_[static_cast<std::size_t>(k)];
      x[i] = coordinates_.outer(static_cast<std::size_t>(i), at[k]);
    }
    return x;
  }
  // Of one constraint, by the unknowns that can move.
  Taylor constraint(std::size_t c, const Eigen::VectorXd& at) const {
    const Taylor one = in_steps(constraints_[c], coordinates_, outer(at));
    const double w = weight_[c];
    return {w * one.value, w * one.slope(open_), w * one.curvature(open_, open_)};
  }
  double value(const Eigen::VectorXd& at) const {
    const Eigen::VectorXd d = at - about;
    return (R * d + q).squaredNorm() + d.dot(S * d);
  }
  Eigen::VectorXd slope(const Eigen::VectorXd& at) const {
    const Eigen::VectorXd d = at - about;
    return 2 * (R.transpose() * (R * d + q) + S * d);
  }
  Eigen::MatrixXd curvature() const { return 2 * (R.transpose() * R + S); }
  void evaluate(const Eigen::VectorXd& at) override {
    r = R * (at - about) + q;
    J = R;
  }
  bool curves() const override { return true; }
  void constrain(const Eigen::VectorXd& at) override {
    g.resize(least.size());
    A.resize(least.size(), at.size());
    for (Eigen::Index c = 0; c < g.size(); ++c) {
      const Taylor one = constraint(static_cast<std::size_t>(c), at);
      g[c] = one.value;
      A.row(c) = one.slope;
    }
  }
  void bend(const Eigen::VectorXd& at, const Eigen::VectorXd& factor, Eigen::MatrixXd& H) override {
    for (Eigen::Index c = 0; c < factor.size(); ++c)
      if (factor[c] != 0) H += factor[c] * constraint(static_cast<std::size_t>(c), at).curvature;
  }

  Eigen::MatrixXd R, S;
  Eigen::VectorXd q, about;

 private:
  const std::vector<SmoothConstraint>& constraints_;
  const Coordinates& coordinates_;
  std::vector<Eigen::Index> open_;
  Eigen::VectorXd all_;
  std::vector<double> weight_;
};

}  // namespace hapsim
