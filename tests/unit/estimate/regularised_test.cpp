// Fields from few data: the weight that the data choose, and what each penalty keeps.
#include "estimate/regularised.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// A line of 40 unknowns, 30 running means of them, noise of 1.
FieldProblem problem(double height, std::uint64_t seed) {
  FieldProblem p;
  constexpr int kUnknowns = 40, kData = 30;
  p.J = Eigen::MatrixXd::Zero(kData, kUnknowns);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(kUnknowns);
  truth.tail(20).setConstant(height);
  Random random(seed);
  for (int i = 0; i < kData; ++i) {
    for (int j = 0; j < 8; ++j) p.J(i, i + j) = 10;
    p.group.push_back(i);
  }
  p.data = p.J * truth;
  for (int i = 0; i < kData; ++i) p.data[i] += random.normal();
  for (int j = 0; j + 1 < kUnknowns; ++j) p.edges.push_back({j, j + 1});
  p.edge_weight = Eigen::VectorXd::Ones(kUnknowns - 1);
  p.node_weight = Eigen::VectorXd::Constant(kUnknowns, 1e-3);
  return p;
}

TEST(Regularised, AStepIsFoundAndIsSteeperWithTotalVariation) {
  const FieldProblem p = problem(1, 3);
  const FieldCandidate smooth = solve_field(p, Penalty::kSmooth).field();
  const FieldCandidate sharp = solve_field(p, Penalty::kTotalVariation).field();
  for (const FieldCandidate* s : {&smooth, &sharp}) {
    EXPECT_NEAR(s->m[5], 0, 0.1);
    EXPECT_NEAR(s->m[35], 1, 0.1);
    EXPECT_LT(s->misfit, 1.3);
  }
  EXPECT_GT(sharp.m[21] - sharp.m[18], smooth.m[21] - smooth.m[18]);
}

TEST(Regularised, NoiseAloneIsNotFitted) {
  const FieldCandidate s = solve_field(problem(0, 5), Penalty::kSmooth).field();
  EXPECT_LT(s.m.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_GT(s.misfit, 0.7);
}

}  // namespace
}  // namespace hapsim
