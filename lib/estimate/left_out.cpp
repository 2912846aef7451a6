#include "estimate/left_out.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <vector>

namespace hapsim {

GroupsLeftOut left_out(const FieldProblem& p, const Eigen::MatrixXd& hat,
                       const Eigen::VectorXd& residual) {
  std::map<int, std::vector<Eigen::Index>> groups;
  for (std::size_t i = 0; i < p.group.size(); ++i)
    groups[p.group[i]].push_back(static_cast<Eigen::Index>(i));
  double squares = 0;
  GroupsLeftOut result;
  for (const auto& [number, rows] : groups) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    const Eigen::MatrixXd own = Eigen::MatrixXd::Identity(n, n) - hat(rows, rows);
    const Eigen::LDLT<Eigen::MatrixXd> solver(own);
    const Eigen::VectorXd left = solver.solve(residual(rows));
    squares += left.squaredNorm();
    result.log_score -= 0.5 * residual(rows).dot(left);
    result.log_score += 0.5 * solver.vectorD().array().max(1e-300).log().sum();
  }
  result.error = std::sqrt(squares / static_cast<double>(residual.size()));
  return result;
}

}  // namespace hapsim
