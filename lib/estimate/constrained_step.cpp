#include "estimate/constrained_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate/ipopt.h"
#include "estimate/quadratic_program.h"
#include "estimate/step_active_set.h"
#include "estimate/step_problem.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUnbounded = 1e200;

// With the sizes of its curvatures, none of which is next to nothing: a step that goes down.
MatrixXd positive(const MatrixXd& H) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);
  const VectorXd size = eigen.eigenvalues().cwiseAbs();
  const VectorXd raised = size.cwiseMax(1e-9 * size.maxCoeff() + 1e-14);
  return eigen.eigenvectors() * raised.asDiagonal() * eigen.eigenvectors().transpose();
}

// The constraints and bounds linearised at p.y, whose g and A are set.
QuadraticProgram linearised(const StepProblem& p, const VectorXd& factor) {
  const Index n = p.y.size();
  QuadraticProgram program;
  program.H = p.curvature();
  for (Index c = 0; c < p.g.size(); ++c)
    if (factor[c] != 0)
      program.H -= factor[c] * p.constraint(static_cast<std::size_t>(c), p.y).curvature;
  program.H = positive(program.H);
  program.f = p.slope(p.y);
  const Index rows = p.g.size() + 2 * n;
  program.A = MatrixXd::Zero(rows, n);
  program.b = VectorXd::Constant(rows, -1);  // a row of nothing is kept
  program.equality.assign(static_cast<std::size_t>(rows), false);
  for (Index c = 0; c < p.g.size(); ++c) {
    program.A.row(c) = p.A.row(c);
    program.b[c] = -p.g[c];
    program.equality[static_cast<std::size_t>(c)] = p.most[c] == 0;
  }
  for (Index i = 0; i < n; ++i) {
    const Index low = p.g.size() + i, high = low + n;
    if (p.low[i] > -kUnbounded) {
      program.A(low, i) = 1;
      program.b[low] = p.low[i] - p.y[i];
    }
    if (p.high[i] < kUnbounded) {
      program.A(high, i) = -1;
      program.b[high] = p.y[i] - p.high[i];
    }
  }
  return program;
}

// Sum of what the constraints are broken by; p.g is set.
double broken(const StepProblem& p) {
  double sum = 0;
  for (Index c = 0; c < p.g.size(); ++c)
    sum += p.most[c] == 0 ? std::abs(p.g[c]) : std::max(0.0, -p.g[c]);
  return sum;
}

// From p.y to the minimum of its valley; p.y is then that. `most`: of a point that is kept.
bool descend_quadratically(StepProblem& p, double most, std::vector<bool>& binds) {
  const Index n = p.y.size(), rows = p.least.size();
  VectorXd factor = VectorXd::Zero(rows);
  double weight = 0;
  std::vector<bool> last_binds;
  Eigen::VectorXi last_held;
  for (int round = 0; round < 60; ++round) {
    p.constrain(p.y);
    if (!p.g.allFinite() || !p.A.allFinite()) return false;
    const QuadraticProgram program = linearised(p, factor);
    const std::optional<QuadraticEnd> end = solve(program);
    if (!end || !end->d.allFinite()) return false;
    factor = end->multiplier.head(rows);
    std::vector<bool> now(static_cast<std::size_t>(rows));
    Eigen::VectorXi held(n);
    for (Index c = 0; c < rows; ++c) now[static_cast<std::size_t>(c)] = factor[c] > 0;
    for (Index i = 0; i < n; ++i)
      held[i] = end->multiplier[rows + i] > 0 ? -1 : end->multiplier[rows + n + i] > 0;
    // The same twice: Newton's method ends it.
    if (now == last_binds && (held.array() == last_held.array()).all()) {
      const VectorXd here = p.y;
      StepActiveSet exact(p, now, held, factor);
      if (exact.run(std::min(most, broken(p) < 1e-9 ? p.value(here) : most))) {
        binds = exact.binds();
        return true;
      }
      p.y = here;
      p.constrain(here);
    }
    last_binds = now;
    last_held = held;
    // Down in the sum with the broken constraints (the l1 merit function).
    weight = std::max(weight, 1.5 * factor.cwiseAbs().maxCoeff() + 1e-12);
    const double merit = p.value(p.y) + weight * broken(p);
    const double slope = program.f.dot(end->d) - weight * broken(p);
    const VectorXd here = p.y;
    double share = 1;
    for (; share > 1e-8; share /= 2) {
      p.y = (here + share * end->d).cwiseMax(p.low).cwiseMin(p.high);
      p.constrain(p.y);
      if (p.value(p.y) + weight * broken(p) <= merit + 1e-4 * share * std::min(0.0, slope)) break;
    }
    if (!(share > 1e-8)) return false;
  }
  return false;
}

}  // namespace

std::optional<ConstrainedStep> constrained_step(const std::vector<SmoothConstraint>& constraints,
                                                const Coordinates& coordinates,
                                                const std::vector<Index>& open, const VectorXd& x,
                                                const MatrixXd& R, const VectorXd& q,
                                                const MatrixXd& S, const StepBox& box,
                                                std::vector<bool>& binds) {
  StepProblem p(constraints, coordinates, open, x);
  p.about = p.inner();
  p.y = p.about;
  p.low = box.low.cwiseMax((p.y.array() - box.reach).matrix());
  p.high = box.high.cwiseMin((p.y.array() + box.reach).matrix());
  const Index n = R.cols();
  // Ipopt's tolerances are for problems of size one. What the residuals do not see stays.
  const double size = std::max(R.norm(), 1e-300);
  p.R = MatrixXd::Zero(R.rows() + n, n);
  p.R.topRows(R.rows()) = R / size;
  p.R.bottomRows(n).diagonal().setConstant(1e-7);
  p.q = VectorXd::Zero(p.R.rows());
  p.q.head(q.size()) = q / size;
  const MatrixXd none = MatrixXd::Zero(n, n);
  p.S = S.size() > 0 ? MatrixXd(S / (size * size)) : none;
  const VectorXd from = p.y;
  const auto found = [&] {
    return ConstrainedStep{p.outer(p.y), size * size * (p.value(from) - p.value(p.y))};
  };
  // What bound before mostly does again, and a few of Newton's steps find that out.
  binds.resize(constraints.size());
  p.constrain(from);
  bool kept = p.g.allFinite();
  for (Index c = 0; c < p.g.size(); ++c) {
    if (p.g[c] < 0) binds[static_cast<std::size_t>(c)] = true;
    kept = kept && p.g[c] >= -kKept && (p.most[c] != 0 || p.g[c] <= kKept);
  }
  double most = kept ? p.value(from) : std::numeric_limits<double>::infinity();
  StepActiveSet near(p, binds);
  if (near.run(most)) {
    binds = near.binds();
    return found();
  }
  p.y = from;
  if (descend_quadratically(p, most, binds)) return found();
  p.y = from;
  p.S = none;
  const IpoptEnd end = minimise_by_ipopt(p, 500);
  if (!end.converged || !p.y.allFinite()) return std::nullopt;
  StepActiveSet exact(p, end);
  if (exact.run(p.value(p.y))) {
    binds = exact.binds();
    return found();
  }
  for (std::size_t c = 0; c < constraints.size(); ++c)
    if (broken_by(constraints[c], p.constraint(c, p.y)) > kKept) return std::nullopt;
  return found();
}

}  // namespace hapsim
