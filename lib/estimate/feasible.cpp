#include "estimate/feasible.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "estimate/stepped_constraint.h"

namespace hapsim {
namespace {

double worst(const std::vector<SmoothConstraint>& constraints, const Coordinates& coordinates,
             const Eigen::VectorXd& x) {
  double most = 0;
  for (const SmoothConstraint& c : constraints) {
    const Taylor g = in_steps(c, coordinates, x);
    if (!std::isfinite(g.value)) return INFINITY;
    most = std::max(most, broken_by(c, g));
  }
  return most;
}

}  // namespace

bool keeps(const std::vector<Unknown>& at, const std::vector<SmoothConstraint>& constraints,
           double near) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) x[static_cast<Eigen::Index>(i)] = at[i].value;
  return worst(constraints, Coordinates(at), x) <= near;
}

std::optional<Eigen::VectorXd> feasible_point(const std::vector<Unknown>& start,
                                              const std::vector<SmoothConstraint>& constraints) {
  const Coordinates coordinates(start);
  const auto rows = static_cast<Eigen::Index>(constraints.size());
  std::vector<Unknown> from = start;
  Random random(1);
  constexpr int kStarts = 25;
  for (int s = 0; s < kStarts; ++s) {
    Eigen::VectorXd x(static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) {
      const double y0 =
          coordinates.inner(i, std::clamp(start[i].value, start[i].lower, start[i].upper));
      const double low = std::max(coordinates.low(i), y0 - 6);
      const double high = std::min(coordinates.high(i), y0 + 6);
      const double share = s == 0 ? 0 : s == 1 ? 0.5 : random.uniform();
      from[i].value = coordinates.outer(i, s == 0 ? y0 : low + share * (high - low));
      x[static_cast<Eigen::Index>(i)] = from[i].value;
    }
    // Each over its slope at the start, so that their units do not count.
    Eigen::VectorXd weight(rows);
    for (Eigen::Index c = 0; c < rows; ++c) {
      const double slope =
          in_steps(constraints[static_cast<std::size_t>(c)], coordinates, x).slope.norm();
      weight[c] = std::isfinite(slope) && slope > 0 ? 1 / slope : 1;
    }
    const ResidualFunction broken = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r,
                                        Eigen::MatrixXd* J) {
      r = Eigen::VectorXd::Zero(rows);
      if (J != nullptr) *J = Eigen::MatrixXd::Zero(rows, at.size());
      for (Eigen::Index c = 0; c < rows; ++c) {
        const SmoothConstraint& constraint = constraints[static_cast<std::size_t>(c)];
        const Taylor g = constraint.at(at);
        if (!constraint.equality && g.value >= 0) continue;
        r[c] = weight[c] * g.value;
        if (J != nullptr) J->row(c) = weight[c] * g.slope.transpose();
      }
    };
    if (worst(constraints, coordinates, x) > kKept) {
      LeastSquaresOptions options;
      options.step_tolerance = 1e-13;
      options.decrease_tolerance = 1e-12;
      x = minimise(from, broken, options).x;
    }
    if (worst(constraints, coordinates, x) <= kKept) return x;
  }
  return std::nullopt;
}

Conflict find_conflict(const std::vector<Unknown>& start,
                       const std::vector<SmoothConstraint>& constraints) {
  std::vector<Unknown> bounded = start;
  Conflict conflict;
  for (std::size_t c = 0; c < constraints.size(); ++c) conflict.constraints.push_back(c);
  const auto kept = [&](const std::vector<std::size_t>& which) {
    std::vector<SmoothConstraint> some;
    for (const std::size_t c : which) some.push_back(constraints[c]);
    return feasible_point(bounded, some).has_value();
  };
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    std::vector<std::size_t> rest = conflict.constraints;
    std::erase(rest, c);
    if (!kept(rest)) conflict.constraints = rest;
  }
  // Bounds of unknowns that no constraint of these sees take no part.
  Eigen::VectorXd x(static_cast<Eigen::Index>(start.size()));
  for (std::size_t i = 0; i < start.size(); ++i) x[static_cast<Eigen::Index>(i)] = start[i].value;
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(x.size());
  for (const std::size_t c : conflict.constraints) seen += constraints[c].at(x).slope.cwiseAbs();
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (seen[static_cast<Eigen::Index>(i)] == 0) continue;
    // Without its bound an unknown may also be what its logarithm forbids.
    Unknown& u = bounded[i];
    if (u.logarithmic) u.scale = std::max(std::abs(u.value), 1e-300);
    u.logarithmic = false;
    u.log_limit = std::numeric_limits<double>::quiet_NaN();
    u.lower = -1e300;
    if (kept(conflict.constraints)) {
      conflict.lower.push_back(i);
      u.lower = start[i].lower;
    }
    u.upper = 1e300;
    if (kept(conflict.constraints)) {
      conflict.upper.push_back(i);
      u.upper = start[i].upper;
    }
  }
  return conflict;
}

}  // namespace hapsim
