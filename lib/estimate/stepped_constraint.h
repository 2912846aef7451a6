// A constraint in the coordinates that are stepped: private to lib/estimate.
#pragma once

#include <algorithm>
#include <cmath>

#include "estimate/coordinates.h"
#include "estimate/smooth_constraint.h"

namespace hapsim {

// By the stepped coordinates y (Coordinates) instead of x.
inline Taylor in_steps(const SmoothConstraint& constraint, const Coordinates& coordinates,
                       const Eigen::VectorXd& x) {
  Taylor g = constraint.at(x);
  Eigen::VectorXd slope(x.size()), bend(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    slope[i] = coordinates.slope(static_cast<std::size_t>(i), x[i]);
    bend[i] = coordinates.bend(static_cast<std::size_t>(i), x[i]);
  }
  g.curvature = slope.asDiagonal() * g.curvature * slope.asDiagonal();
  g.curvature.diagonal() += g.slope.cwiseProduct(bend);
  g.slope = g.slope.cwiseProduct(slope);
  return g;
}

// By how far a constraint is broken, in stepped coordinates (g over its slope); 0 where it is kept.
inline double broken_by(const SmoothConstraint& constraint, const Taylor& g) {
  const double missing = constraint.equality ? std::abs(g.value) : std::max(0.0, -g.value);
  return missing == 0 ? 0 : missing / std::max(g.slope.norm(), 1e-300);
}

// A point so near to a constraint keeps it: rounding of values that a model file holds.
constexpr double kKept = 1e-9;

}  // namespace hapsim
