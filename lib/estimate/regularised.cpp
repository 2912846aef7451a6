#include "estimate/regularised.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "estimate/left_out.h"
#include "estimate/penalty_matrix.h"

namespace hapsim {
namespace {

using Solver = Eigen::LDLT<Eigen::MatrixXd>;

Solver data_space(const Eigen::MatrixXd& JG, double weight) {
  return Solver(JG / weight + Eigen::MatrixXd::Identity(JG.rows(), JG.rows()));
}

FieldCandidate with_weight(const FieldProblem& p, const Eigen::MatrixXd& G, const Solver& solver,
                           double weight) {
  const Eigen::Index n = p.data.size();
  FieldCandidate s;
  s.weight = weight;
  s.m = G * solver.solve(p.data) / weight;
  const Eigen::VectorXd residual = p.data - p.J * s.m;
  s.misfit = std::sqrt(residual.squaredNorm() / static_cast<double>(n));
  const Eigen::MatrixXd hat =
      Eigen::MatrixXd::Identity(n, n) - solver.solve(Eigen::MatrixXd::Identity(n, n));
  const GroupsLeftOut left = left_out(p, hat, residual);
  s.held_out = left.error;
  s.log_score = left.log_score;
  return s;
}

}  // namespace

FieldSolution solve_field(const FieldProblem& p, Penalty penalty, int threads) {
  // Of weights whose errors differ by less than this allows, the smoothest is taken.
  constexpr double kAlike = 1.05;
  constexpr int kReweightings = 6, kWeights = 13;
  const auto edges = static_cast<Eigen::Index>(p.edges.size());
  const Eigen::MatrixXd G = PenaltyMatrix(p).inverse_times_J(Eigen::VectorXd::Ones(edges));
  const Eigen::MatrixXd JG = p.J * G;
  // Weights from nearly no penalty to nearly nothing but it, by the eigenvalues of J R^-1 J': the
  // largest belong to what the penalty hardly holds, as a common constant.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(JG, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double high = 10 * values[values.size() - 1];
  const double low = std::max(1e-14 * high, 1e-2 * values[values.size() / 2]);
  std::vector<FieldCandidate> tried(kWeights);
  in_parallel(kWeights, threads, [&](std::size_t k) {
    const double weight = low * std::pow(high / low, static_cast<double>(k) / (kWeights - 1.0));
    Solver solver = data_space(JG, weight);
    if (penalty == Penalty::kSmooth) {
      tried[k] = with_weight(p, G, solver, weight);
      return;
    }
    PenaltyMatrix matrix(p);
    Eigen::MatrixXd own = G;
    for (int round = 0; round < kReweightings; ++round) {
      const Eigen::VectorXd m = own * solver.solve(p.data) / weight;
      own = matrix.inverse_times_J(
          edge_factors(p, m, [](double t) { return kEdge / std::sqrt(t * t + kEdge * kEdge); }));
      solver = data_space(p.J * own, weight);
    }
    tried[k] = with_weight(p, own, solver, weight);
  });
  double least = tried.front().held_out;
  for (const FieldCandidate& s : tried) least = std::min(least, s.held_out);
  std::size_t chosen = tried.size() - 1;
  while (chosen > 0 && !(tried[chosen].held_out <= kAlike * least)) --chosen;
  return {std::move(tried), chosen};
}

}  // namespace hapsim
