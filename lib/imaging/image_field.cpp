#include "imaging/image_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimate/field_posterior.h"

namespace hapsim {

ImageField image_field(const Eigen::MatrixXd& J, const FieldGrid& fine,
                       const std::vector<int>& group, const Eigen::VectorXd& data,
                       const Eigen::VectorXd& error, Penalty penalty, int threads) {
  FieldGrid grid = fine;
  grid.step = 2 * fine.step;
  for (int& n : grid.count) n = (n + 2) / 2;
  FieldProblem problem;
  problem.J = Eigen::MatrixXd::Zero(J.rows(), static_cast<Eigen::Index>(grid.size()));
  Eigen::VectorXd weights(static_cast<Eigen::Index>(grid.size()));
  for (std::size_t n = 0; n < fine.size(); ++n) {
    weights.setZero();
    grid.add_weights(fine.node(n), 1, weights);
    for (Eigen::Index k = 0; k < weights.size(); ++k)
      if (weights[k] != 0) problem.J.col(k) += weights[k] * J.col(static_cast<Eigen::Index>(n));
  }
  Eigen::VectorXd seen = problem.J.colwise().norm().transpose();
  seen = (seen / seen.maxCoeff()).cwiseMax(1e-4).cwiseSqrt();
  problem.J = error.cwiseInverse().asDiagonal() * problem.J;
  problem.data = data.cwiseQuotient(error);
  problem.group = group;
  std::vector<double> edge_weight;
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) {
        const std::size_t a = grid.index(i, j, k);
        const auto join = [&](bool there, std::size_t b) {
          if (!there) return;
          problem.edges.push_back({static_cast<int>(a), static_cast<int>(b)});
          edge_weight.push_back(
              0.5 * (seen[static_cast<Eigen::Index>(a)] + seen[static_cast<Eigen::Index>(b)]));
        };
        join(i + 1 < grid.count[0], a + 1);
        join(j + 1 < grid.count[1], grid.index(i, j + 1, k));
        join(k + 1 < grid.count[2], grid.index(i, j, k + 1));
      }
  problem.edge_weight = Eigen::Map<const Eigen::VectorXd>(
      edge_weight.data(), static_cast<Eigen::Index>(edge_weight.size()));
  problem.node_weight = 0.02 * seen;
  // That the modulus somewhere is twice the model's is nothing that presses elsewhere can tell.
  problem.least_spread = std::log(2.0);
  const FieldSolution s = solve_field(problem, penalty, threads);
  std::vector<Vec3> place;
  for (std::size_t n = 0; n < grid.size(); ++n) place.push_back(grid.node(n));
  FieldPosterior posterior = field_posterior(problem, s, penalty, place, threads);
  const FieldCandidate& f = s.field();
  const double unit = std::sqrt(error.cwiseAbs2().mean());
  return {grid,
          f.m,
          std::move(posterior.std_error),
          std::move(posterior.resolution),
          f.weight,
          f.misfit * unit,
          f.held_out * unit};
}

}  // namespace hapsim
