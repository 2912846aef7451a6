#include "estimate/constrained.h"

#include <Eigen/Dense>
#include <cmath>
#include <coin/IpIpoptApplication.hpp>
#include <coin/IpSolveStatistics.hpp>
#include <coin/IpTNLP.hpp>
#include <mutex>

#include "estimate/coordinates.h"
#include "estimate/normal_inverse.h"

namespace hapsim {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// The problem in stepped coordinates y; residuals are kept for the last y asked.
class Problem : public Ipopt::TNLP {
 public:
  Problem(const std::vector<Unknown>& unknowns, const std::vector<LinearConstraint>& constraints,
          const ResidualFunction& residuals)
      : unknowns_(unknowns),
        constraints_(constraints),
        residuals_(residuals),
        coordinates_(unknowns),
        m_(static_cast<Index>(unknowns.size())) {
    y_.resize(m_);
    for (Index i = 0; i < m_; ++i) {
      const Unknown& u = unknowns_[at(i)];
      y_[i] = coordinates_.inner(at(i), std::clamp(u.value, u.lower, u.upper));
    }
  }
  const Eigen::VectorXd& solution() const { return y_; }
  Eigen::VectorXd outer(const Eigen::VectorXd& y) const {
    Eigen::VectorXd x(m_);
    for (Index i = 0; i < m_; ++i) x[i] = coordinates_.outer(at(i), y[i]);
    return x;
  }
  // J by y and r at y.
  void evaluate(const Eigen::VectorXd& y) {
    if (r_.size() > 0 && y == evaluated_) return;
    const Eigen::VectorXd x = outer(y);
    residuals_(x, r_, &J_);
    for (Index i = 0; i < m_; ++i) J_.col(i) *= coordinates_.slope(at(i), x[i]);
    evaluated_ = y;
  }
  const Eigen::VectorXd& r() const { return r_; }
  const Eigen::MatrixXd& J() const { return J_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian,
                    IndexStyleEnum& style) override {
    n = m_;
    m = static_cast<Index>(constraints_.size());
    jacobian = n * m;
    hessian = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* least,
                       Number* most) override {
    for (Index i = 0; i < n; ++i) {
      low[i] = std::max(-1e20, coordinates_.low(at(i)));  // Ipopt's infinity is 1e19
      high[i] = std::min(1e20, coordinates_.high(at(i)));
    }
    for (Index c = 0; c < m; ++c) {
      least[c] = std::max(-1e20, constraints_[at(c)].lower);
      most[c] = std::min(1e20, constraints_[at(c)].upper);
    }
    return true;
  }
  bool get_starting_point(Index n, bool, Number* y, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::copy(y_.data(), y_.data() + n, y);
    return true;
  }
  bool eval_f(Index n, const Number* y, bool, Number& value) override {
    evaluate(Eigen::Map<const Eigen::VectorXd>(y, n));
    value = r_.squaredNorm();
    return std::isfinite(value);
  }
  bool eval_grad_f(Index n, const Number* y, bool, Number* gradient) override {
    evaluate(Eigen::Map<const Eigen::VectorXd>(y, n));
    Eigen::Map<Eigen::VectorXd>(gradient, n) = 2 * J_.transpose() * r_;
    return true;
  }
  bool eval_g(Index n, const Number* y, bool, Index m, Number* g) override {
    for (Index c = 0; c < m; ++c)
      g[c] = coefficients(c).dot(Eigen::Map<const Eigen::VectorXd>(y, n));
    return true;
  }
  bool eval_jac_g(Index n, const Number*, bool, Index m, Index, Index* row, Index* column,
                  Number* values) override {
    for (Index c = 0, k = 0; c < m; ++c)
      for (Index i = 0; i < n; ++i, ++k) {
        if (values != nullptr) {
          values[k] = coefficients(c)[i];
        } else {
          row[k] = c;
          column[k] = i;
        }
      }
    return true;
  }
  bool eval_h(Index n, const Number* y, bool, Number factor, Index, const Number*, bool, Index,
              Index* row, Index* column, Number* values) override {
    Eigen::MatrixXd H;
    if (values != nullptr) {
      evaluate(Eigen::Map<const Eigen::VectorXd>(y, n));
      H = 2 * factor * J_.transpose() * J_;
    }
    for (Index i = 0, k = 0; i < n; ++i)
      for (Index j = 0; j <= i; ++j, ++k) {
        if (values != nullptr) {
          values[k] = H(i, j);
        } else {
          row[k] = i;
          column[k] = j;
        }
      }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* y, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    y_ = Eigen::Map<const Eigen::VectorXd>(y, n);
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  Eigen::Map<const Eigen::VectorXd> coefficients(Index c) const {
    return {constraints_[at(c)].coefficient.data(), m_};
  }

  const std::vector<Unknown>& unknowns_;
  const std::vector<LinearConstraint>& constraints_;
  const ResidualFunction& residuals_;
  Coordinates coordinates_;
  Index m_;
  Eigen::VectorXd y_, evaluated_, r_;
  Eigen::MatrixXd J_;
};

std::string message_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "converged";
    case Ipopt::Solved_To_Acceptable_Level:
      return "converged to an acceptable level only";
    case Ipopt::Infeasible_Problem_Detected:
      return "no point keeps all constraints";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "too many iterations";
    case Ipopt::Restoration_Failed:
      return "no way back to the constraints was found";
    case Ipopt::Invalid_Number_Detected:
      return "the start gives no finite forces";
    default:
      return "Ipopt stopped with status " + std::to_string(static_cast<int>(status));
  }
}

}  // namespace

ConstrainedResult minimise_constrained(const std::vector<Unknown>& start,
                                       const std::vector<LinearConstraint>& constraints,
                                       const ResidualFunction& residuals,
                                       const LeastSquaresOptions& options) {
  static std::mutex one_at_a_time;  // MUMPS keeps a state of its own
  const std::lock_guard lock(one_at_a_time);
  const auto m = static_cast<Eigen::Index>(start.size());
  auto* problem = new Problem(start, constraints, residuals);  // owned by the pointer below
  const Ipopt::SmartPtr<Ipopt::TNLP> owner = problem;
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = IpoptApplicationFactory();
  application->Options()->SetIntegerValue("print_level", 0);
  application->Options()->SetStringValue("sb", "yes");
  application->Options()->SetIntegerValue("max_iter", options.max_iterations);
  application->Options()->SetNumericValue("tol", 1e-9);
  // Bounds are kept exactly, so that logarithms stay defined.
  application->Options()->SetNumericValue("bound_relax_factor", 0);
  application->Options()->SetStringValue("jac_c_constant", "yes");
  application->Options()->SetStringValue("jac_d_constant", "yes");
  ConstrainedResult result;
  result.fit.message = "Ipopt cannot start";
  result.active.assign(constraints.size(), false);
  if (application->Initialize() != Ipopt::Solve_Succeeded) return result;
  const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(owner);

  LeastSquaresResult& fit = result.fit;
  const Eigen::VectorXd y = problem->solution();
  fit.message = message_of(status);
  fit.converged = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  if (IsValid(application->Statistics()))
    fit.iterations = application->Statistics()->IterationCount();
  problem->evaluate(y);
  fit.x = problem->outer(y);
  fit.sum_of_squares = problem->r().squaredNorm();
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
  fit.covariance = way * normal_inverse(problem->J() * free) * way.transpose();
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
