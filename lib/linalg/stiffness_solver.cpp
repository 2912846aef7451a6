#include "linalg/stiffness_solver.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/error.h"

namespace hapsim {
namespace {

// Of a solution: the energy, and with it a stiffness, errs by its square.
constexpr double kResidual = 1e-9;

// Seconds on one core, fitted to blocks of 5,000 to 100,000 tetrahedra of both orders (nu = 0.45;
// bench_sizes): factorising fills in, iterating only reads what is there, four columns at a time.
double direct_seconds(double unknowns, double entries) {
  return 1.5 * std::pow(unknowns / 51600, 1.75) * std::pow(entries / unknowns / 21.5, 0.7);
}
// The grid without nodes in the middles of edges saves most of the steps and costs two of three of
// those that are left (bench_calculix).
double iterative_seconds(double unknowns, double entries, int columns, int order) {
  return (order == 2 ? 0.5 : 1.3) * 1e-8 * entries * std::cbrt(unknowns) * ((columns + 3) / 4);
}

}  // namespace

SolverChoice choose_solver(SolverKind wished, int unknowns, std::size_t entries,
                           int right_hand_sides, int order) {
  const double e = static_cast<double>(entries);
  const double direct = direct_seconds(unknowns, e);
  const double iterative = iterative_seconds(unknowns, e, right_hand_sides, order);
  SolverChoice choice;
  choice.kind = wished;
  if (wished == SolverKind::kBySize)
    choice.kind = direct <= iterative ? SolverKind::kDirect : SolverKind::kIterative;
  choice.why = fmt::format(
      "{}: {} unknowns, {} right-hand sides; about {:.2g} s direct, {:.2g} s iterative{}",
      choice.kind == SolverKind::kDirect ? "sparse Cholesky" : "conjugate gradients", unknowns,
      right_hand_sides, direct, iterative, wished == SolverKind::kBySize ? "" : "; as asked");
  return choice;
}

StiffnessSolver::StiffnessSolver(const SymmetricSparse& pattern, SolverKind kind,
                                 std::vector<int> order) {
  if (kind == SolverKind::kIterative)
    iterative_ = std::make_unique<ConjugateGradients>();
  else
    direct_ = std::make_unique<SparseCholesky>(pattern, 3, std::move(order));
}

bool StiffnessSolver::factorise(const SymmetricSparse& matrix) {
  return direct_ ? direct_->factorise(matrix) : iterative_->prepare(matrix, 3);
}

bool StiffnessSolver::factorise(SymmetricSparse&& matrix, const BlockEnds& ends) {
  return direct_ ? direct_->factorise(matrix) : iterative_->prepare(std::move(matrix), 3, ends);
}

Eigen::MatrixXd StiffnessSolver::solve(const Eigen::MatrixXd& b) const {
  if (direct_) return direct_->solve(b);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(b.rows(), b.cols());
  const IterationReport report = iterative_->solve(b, x, kResidual);
  if (!report.converged)
    fail_numerics("",
                  fmt::format("conjugate gradients stopped after {} steps at a residual of {:.1g}",
                              report.iterations, report.residual),
                  "use the direct solver, or a mesh of better elements");
  return x;
}

}  // namespace hapsim
