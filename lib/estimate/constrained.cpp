#include "estimate/constrained.h"

#include <Eigen/Dense>
#include <cmath>

#include "estimate/coordinates.h"
#include "estimate/ipopt.h"
#include "estimate/normal_inverse.h"

namespace hapsim {
namespace {

// The problem in stepped coordinates y; residuals are kept for the last y asked.
class Problem : public IpoptProblemOf {
 public:
  Problem(const std::vector<Unknown>& unknowns, const std::vector<LinearConstraint>& constraints,
          const ResidualFunction& residuals)
      : residuals_(residuals), coordinates_(unknowns) {
    const auto m = static_cast<Eigen::Index>(unknowns.size());
    const auto rows = static_cast<Eigen::Index>(constraints.size());
    y = low = high = Eigen::VectorXd(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const auto u = static_cast<std::size_t>(i);
      y[i] = coordinates_.inner(
          u, std::clamp(unknowns[u].value, unknowns[u].lower, unknowns[u].upper));
      low[i] = coordinates_.low(u);
      high[i] = coordinates_.high(u);
    }
    A.resize(rows, m);
    least = most = Eigen::VectorXd(rows);
    for (Eigen::Index c = 0; c < rows; ++c) {
      const LinearConstraint& constraint = constraints[static_cast<std::size_t>(c)];
      A.row(c) = Eigen::Map<const Eigen::RowVectorXd>(constraint.coefficient.data(), m);
      least[c] = constraint.lower;
      most[c] = constraint.upper;
    }
  }
  Eigen::VectorXd outer(const Eigen::VectorXd& inner) const {
    Eigen::VectorXd x(inner.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = coordinates_.outer(static_cast<std::size_t>(i), inner[i]);
    return x;
  }
  // J by y and r at y.
  void evaluate(const Eigen::VectorXd& inner) override {
    if (r.size() > 0 && inner == evaluated_) return;
    const Eigen::VectorXd x = outer(inner);
    residuals_(x, r, &J);
    for (Eigen::Index i = 0; i < x.size(); ++i)
      J.col(i) *= coordinates_.slope(static_cast<std::size_t>(i), x[i]);
    evaluated_ = inner;
  }

 private:
  const ResidualFunction& residuals_;
  Coordinates coordinates_;
  Eigen::VectorXd evaluated_;
};

}  // namespace

ConstrainedResult minimise_constrained(const std::vector<Unknown>& start,
                                       const std::vector<LinearConstraint>& constraints,
                                       const ResidualFunction& residuals,
                                       const LeastSquaresOptions& options) {
  const auto m = static_cast<Eigen::Index>(start.size());
  Problem problem(start, constraints, residuals);
  const IpoptEnd end = minimise_by_ipopt(problem, options.max_iterations);
  ConstrainedResult result;
  result.active.assign(constraints.size(), false);
  LeastSquaresResult& fit = result.fit;
  fit.message = end.message;
  fit.converged = end.converged;
  fit.iterations = end.iterations;
  if (!end.began) return result;
  const Eigen::VectorXd& y = problem.y;
  problem.evaluate(y);
  fit.x = problem.outer(y);
  fit.sum_of_squares = problem.r.squaredNorm();
  fit.undetermined.assign(start.size(), false);

  // What binds: rows of A y = b. The covariance lives in their null space.
  const Coordinates coordinates(start);
  std::vector<Eigen::VectorXd> binding;
  constexpr double kNear = 1e-5;  // scales: an interior point ends a little before a bound
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto u = static_cast<std::size_t>(i);
    const bool held = y[i] < coordinates.low(u) + kNear || y[i] > coordinates.high(u) - kNear;
    fit.at_bound.push_back(held);
    if (held) binding.push_back(Eigen::VectorXd::Unit(m, i));
  }
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const Eigen::Map<const Eigen::VectorXd> a(constraints[c].coefficient.data(), m);
    const double value = a.dot(y);
    result.active[c] = value < constraints[c].lower + kNear || value > constraints[c].upper - kNear;
    if (result.active[c]) binding.emplace_back(a);
  }
  Eigen::MatrixXd free = Eigen::MatrixXd::Identity(m, m);
  if (!binding.empty()) {
    Eigen::MatrixXd A(static_cast<Eigen::Index>(binding.size()), m);
    for (Eigen::Index b = 0; b < A.rows(); ++b) A.row(b) = binding[b].transpose();
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
    free = lu.dimensionOfKernel() == 0 ? Eigen::MatrixXd::Zero(m, 1) : Eigen::MatrixXd(lu.kernel());
  }
  Eigen::VectorXd slope(m);
  for (Eigen::Index i = 0; i < m; ++i)
    slope[i] = coordinates.slope(static_cast<std::size_t>(i), fit.x[i]);
  const Eigen::MatrixXd way = slope.asDiagonal() * free;
  fit.covariance = way * normal_inverse(problem.J * free) * way.transpose();
  return result;
}

std::vector<LinearConstraint> keep_apart(std::size_t count, const std::vector<std::size_t>& ordered,
                                         double ratio) {
  std::vector<LinearConstraint> result;
  for (std::size_t k = 1; k < ordered.size(); ++k) {
    LinearConstraint constraint;
    constraint.coefficient.assign(count, 0);
    constraint.coefficient[ordered[k]] = 1;
    constraint.coefficient[ordered[k - 1]] = -1;
    constraint.lower = std::log(ratio);
    result.push_back(constraint);
  }
  return result;
}

}  // namespace hapsim
