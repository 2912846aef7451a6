// A smooth function over the plan view whose sign says in which of two regions a place lies.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// A plane and a thin-plate spline about knots (Duchon, 1977; Wahba, Spline Models for Observational
// Data, 1990): of all functions with these values at the knots the one that bends least, linear far
// from them. phi(p) = basis(p) theta [m]; theta has three numbers of the plane, then one a mode,
// smoothest first, so that the bending energy is the sum of the modes' squares (in lengths of
// reach()). Where its slope is 1, phi is about the distance [m] from the curve phi = 0.
class PlanLevel {
 public:
  PlanLevel() = default;
  // At least four knots that are not on one line; at most `modes` modes.
  PlanLevel(const std::vector<Eigen::Vector2d>& knots, int modes);

  static constexpr Eigen::Index kPlane = 3;
  Eigen::Index size() const { return kPlane + mode_.cols(); }
  double reach() const { return reach_; }  // of the knots from their middle [m]
  Eigen::RowVectorXd basis(const Eigen::Vector2d& p) const;
  Eigen::MatrixXd slope(const Eigen::Vector2d& p) const;  // 2 x size(), of the basis [-]
  double value(const Eigen::Vector2d& p, const Eigen::VectorXd& theta) const {
    return basis(p).dot(theta);
  }

  // phi over its slope: to first order the distance from the curve [m], and its derivatives by
  // theta on the curve.
  struct Distance {
    double value = 0;
    Eigen::RowVectorXd by_theta;
  };
  Distance distance(const Eigen::Vector2d& p, const Eigen::VectorXd& theta) const;

  // Least squares for values [m] at points, which bends as little as `stiffness` asks for.
  Eigen::VectorXd fitted(const std::vector<Eigen::Vector2d>& points, const Eigen::VectorXd& values,
                         double stiffness) const;

 private:
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double reach_ = 1;
  Eigen::MatrixXd knots_;  // n x 2, from the middle over the reach
  Eigen::MatrixXd mode_;   // n x modes: kernels' factors
};

}  // namespace hapsim
