// What data leave open of a field: against dense inverses, a Markov chain, and drawn truths.
#include "estimate/field_posterior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

constexpr int kSide = 6, kNodes = kSide * kSide, kMeans = 20;

// A square of 6 x 6 unknowns, 20 random means of them, noise of 1.
FieldProblem problem(std::uint64_t seed) {
  FieldProblem p;
  Random random(seed);
  p.J = Eigen::MatrixXd::Zero(kMeans, kNodes);
  for (int i = 0; i < kMeans; ++i) {
    for (int j = 0; j < kNodes; ++j) p.J(i, j) = std::max(0.0, 4 * random.normal());
    p.group.push_back(i / 2);
  }
  for (int i = 0; i < kNodes; ++i) {
    if (i % kSide + 1 < kSide) p.edges.push_back({i, i + 1});
    if (i + kSide < kNodes) p.edges.push_back({i, i + kSide});
  }
  p.edge_weight = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(p.edges.size()), 1.5);
  p.node_weight = Eigen::VectorXd::Constant(kNodes, 0.2);
  p.data = Eigen::VectorXd::Zero(kMeans);
  return p;
}

std::vector<Vec3> places() {
  std::vector<Vec3> place;
  for (int i = 0; i < kNodes; ++i) place.push_back({1.0 * (i % kSide), 1.0 * (i / kSide), 0});
  return place;
}

// sqrt(t^2 + 0.02^2) - 0.02, twice 0.02 times, which is t^2 for small t.
double total_variation(double t) {
  return 2 * 0.02 * (std::sqrt(t * t + 0.02 * 0.02) - 0.02);
}

Eigen::MatrixXd smooth_penalty(const FieldProblem& p) {
  Eigen::MatrixXd R = p.node_weight.cwiseAbs2().asDiagonal();
  for (std::size_t e = 0; e < p.edges.size(); ++e) {
    Eigen::VectorXd d = Eigen::VectorXd::Zero(kNodes);
    d[p.edges[e][0]] = p.edge_weight[static_cast<Eigen::Index>(e)];
    d[p.edges[e][1]] = -p.edge_weight[static_cast<Eigen::Index>(e)];
    R += d * d.transpose();
  }
  return R;
}

// Second derivative of half the objective by central differences of it.
Eigen::MatrixXd curvature(const FieldProblem& p, const FieldCandidate& at) {
  const auto half = [&](const Eigen::VectorXd& m) {
    return 0.5 * ((p.J * m - p.data).squaredNorm() + at.weight * m.dot(smooth_penalty(p) * m));
  };
  constexpr double h = 1e-2;  // of a quadratic form: exact but for rounding
  Eigen::MatrixXd H(kNodes, kNodes);
  for (int i = 0; i < kNodes; ++i)
    for (int j = 0; j <= i; ++j) {
      const auto moved = [&](double a, double b) {
        Eigen::VectorXd m = at.m;
        m[i] += a * h;
        m[j] += b * h;
        return half(m);
      };
      H(i, j) = H(j, i) = (moved(1, 1) - moved(1, -1) - moved(-1, 1) + moved(-1, -1)) / (4 * h * h);
    }
  return H;
}

// The normal equations' solution, about which a smooth posterior is exact.
Eigen::VectorXd smooth_mean(const FieldProblem& p, double weight) {
  return (p.J.transpose() * p.J + weight * smooth_penalty(p)).llt().solve(p.J.transpose() * p.data);
}

TEST(FieldPosterior, OfASmoothFieldIsTheInverseOfTheCurvature) {
  FieldProblem p = problem(3);
  p.data.setLinSpaced(-2, 3);
  {
    const FieldCandidate at{smooth_mean(p, 30), 30};
    const FieldPosterior posterior = field_posterior(p, {{at}, 0}, Penalty::kSmooth, places());
    const Eigen::MatrixXd C = curvature(p, at).inverse();
    for (int i = 0; i < kNodes; ++i)
      EXPECT_NEAR(posterior.std_error[i] / std::sqrt(C(i, i)), 1, 1e-4) << i;
    const Eigen::MatrixXd M = C * p.J.transpose() * p.J;
    for (int i = 0; i < kNodes; ++i) {
      double squares = 0;
      for (int j = 0; j < kNodes; ++j)
        squares += M(i, j) * M(i, j) *
                   (places()[static_cast<std::size_t>(j)] - places()[static_cast<std::size_t>(i)])
                       .squaredNorm();
      EXPECT_NEAR(posterior.resolution[i] / std::sqrt(squares / M.row(i).squaredNorm()), 1, 1e-3);
    }
  }
}

TEST(FieldPosterior, WeightsCountByTheDataLeftOut) {
  FieldProblem p = problem(3);
  p.data.setLinSpaced(-2, 3);
  const FieldSolution s = solve_field(p, Penalty::kSmooth);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(kNodes);
  double total = 0, best = -1e300;
  for (const FieldCandidate& c : s.tried) best = std::max(best, c.log_score);
  for (const FieldCandidate& c : s.tried) {
    if (c.log_score < best - 5) continue;
    const double share = std::exp(c.log_score - best);
    const Eigen::MatrixXd C = (p.J.transpose() * p.J + c.weight * smooth_penalty(p)).inverse();
    expected += share * (C.diagonal() + (c.m - s.field().m).cwiseAbs2());
    total += share;
  }
  const Eigen::VectorXd got = field_posterior(p, s, Penalty::kSmooth, places()).std_error;
  EXPECT_LT((got - (expected / total).cwiseSqrt()).cwiseQuotient(got).cwiseAbs().maxCoeff(), 1e-6);
}

// The score of a weight, by fits without each group.
TEST(FieldPosterior, TheScoreIsTheDensityOfGroupsLeftOut) {
  FieldProblem p = problem(3);
  p.data.setLinSpaced(-2, 3);
  const FieldSolution s = solve_field(p, Penalty::kSmooth);
  const FieldCandidate &a = s.tried[3], &b = s.tried[6];
  const auto score = [&](double weight) {
    double sum = 0;
    for (int g = 0; g < kMeans / 2; ++g) {
      FieldProblem rest = p;
      rest.J.middleRows(2 * g, 2).setZero();
      const Eigen::MatrixXd C =
          (rest.J.transpose() * rest.J + weight * smooth_penalty(p)).inverse();
      const Eigen::MatrixXd J = p.J.middleRows(2 * g, 2);
      const Eigen::MatrixXd V = J * C * J.transpose() + Eigen::MatrixXd::Identity(2, 2);
      const Eigen::VectorXd off =
          p.data.segment(2 * g, 2) - J * (C * (rest.J.transpose() * p.data));
      sum -= 0.5 * off.dot(V.inverse() * off) + 0.5 * std::log(V.determinant());
    }
    return sum;
  };
  EXPECT_NEAR(a.log_score - b.log_score, score(a.weight) - score(b.weight), 1e-6);
}

// Data without any contrast, and places that no datum reaches: as wide as was asked.
TEST(FieldPosterior, WhatNoDatumReachesIsAsOpenAsAsked) {
  FieldProblem p = problem(3);
  p.J.rightCols(kNodes / 2).setZero();
  p.data.setZero();
  for (const Penalty penalty : {Penalty::kSmooth, Penalty::kTotalVariation}) {
    const FieldSolution s = solve_field(p, penalty);
    const double sure = field_posterior(p, s, penalty, places()).std_error.tail(6).minCoeff();
    p.least_spread = std::log(2.0);
    const double open = field_posterior(p, s, penalty, places()).std_error.tail(6).minCoeff();
    p.least_spread = 0;
    EXPECT_LT(sure, 0.25);
    EXPECT_GT(open, 0.35);
    EXPECT_LT(open, 3);
  }
}

// Truths drawn from the prior of a weight, data drawn of them, all of it sought anew: the share
// of unknowns within 95 %.
TEST(FieldPosterior, HoldsDrawnTruths) {
  constexpr double kWeight = 20;
  const FieldProblem p = problem(5);
  const Eigen::MatrixXd R = smooth_penalty(p);
  const Eigen::LLT<Eigen::MatrixXd> factor(kWeight * R);
  Random random(11);
  const auto normal = [&](int n) {
    Eigen::VectorXd z(n);
    for (double& v : z) v = random.normal();
    return z;
  };
  double known = 0, sought = 0;
  constexpr int kDraws = 100;
  for (int draw = 0; draw < kDraws; ++draw) {
    FieldProblem drawn = p;
    const Eigen::VectorXd truth = factor.matrixU().solve(normal(kNodes));
    drawn.data = p.J * truth + normal(kMeans);
    const auto inside = [&](const FieldSolution& s) {
      const FieldPosterior post = field_posterior(drawn, s, Penalty::kSmooth, places());
      return ((truth - s.field().m).cwiseAbs().array() < 1.96 * post.std_error.array())
          .cast<double>()
          .mean();
    };
    known += inside({{{smooth_mean(drawn, kWeight), kWeight}}, 0}) / kDraws;
    sought += inside(solve_field(drawn, Penalty::kSmooth)) / kDraws;
  }
  EXPECT_NEAR(known, 0.95, 0.015);
  EXPECT_GT(sought, 0.88);
}

// Metropolis' chain over the density itself, one unknown at a time.
TEST(FieldPosterior, OfTotalVariationIsOfTheSizeThatAChainFinds) {
  FieldProblem p = problem(7);
  Random random(13);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(kNodes);
  for (int i = 0; i < kNodes; ++i) truth[i] = i % kSide > 2 ? 0.3 : 0;
  p.data = p.J * truth;
  for (double& d : p.data) d += random.normal();
  const FieldSolution solution = solve_field(p, Penalty::kTotalVariation);
  const FieldCandidate& at = solution.field();
  const FieldPosterior posterior =
      field_posterior(p, {{at}, 0}, Penalty::kTotalVariation, places());
  std::vector<std::vector<std::pair<int, double>>> beside(kNodes);
  for (std::size_t e = 0; e < p.edges.size(); ++e)
    for (int side = 0; side < 2; ++side)
      beside[static_cast<std::size_t>(p.edges[e][side])].push_back(
          {p.edges[e][1 - side], p.edge_weight[static_cast<Eigen::Index>(e)]});
  Eigen::VectorXd m = at.m, left = p.J * m - p.data;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kNodes);
  constexpr int kSweeps = 40000, kBurn = 4000;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < kNodes; ++i) {
      const double to = m[i] + 1.5 * posterior.std_error[i] * random.normal();
      const Eigen::VectorXd moved = left + p.J.col(i) * (to - m[i]);
      double change = moved.squaredNorm() - left.squaredNorm();
      const double w = p.node_weight[i] * p.node_weight[i];
      change += at.weight * w * (to * to - m[i] * m[i]);
      for (const auto& [j, weight] : beside[static_cast<std::size_t>(i)])
        change += at.weight *
                  (total_variation(weight * (to - m[j])) - total_variation(weight * (m[i] - m[j])));
      if (random.uniform() >= std::exp(-0.5 * change)) continue;
      m[i] = to;
      left = moved;
    }
    if (sweep >= kBurn) sum += (m - at.m).cwiseAbs2();
  }
  const Eigen::VectorXd chain = (sum / (kSweeps - kBurn)).cwiseSqrt();
  const double ratio = posterior.std_error.cwiseQuotient(chain).mean();
  EXPECT_GT(ratio, 0.5) << ratio;
  EXPECT_LT(ratio, 2) << ratio;
  RecordProperty("laplace_over_chain", std::to_string(ratio));
}

}  // namespace
}  // namespace hapsim
