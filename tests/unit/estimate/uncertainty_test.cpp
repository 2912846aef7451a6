#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "estimate/constrained.h"
#include "estimate/identifiability.h"
#include "estimate/multi_start.h"
#include "estimate/normal_inverse.h"
#include "estimate/profile.h"
#include "estimate/robust.h"

namespace hapsim {
namespace {

// y = a + b t at t = 0 .. n - 1, noise 1; `wild` of the readings lie 50 off.
struct Line {
  std::vector<double> y;
  Line(int n, std::uint64_t seed, int wild = 0) {
    Random random(seed);
    for (int i = 0; i < n; ++i) y.push_back(3 + 0.5 * i + random.normal());
    for (int k = 0; k < wild; ++k) y[static_cast<std::size_t>(7 * k + 3)] += 50;
  }
  void operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    r.resize(static_cast<Eigen::Index>(y.size()));
    if (J != nullptr) J->resize(r.size(), 2);
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double t = static_cast<double>(i);
      r[i] = x[0] + x[1] * t - y[static_cast<std::size_t>(i)];
      if (J != nullptr) J->row(i) << 1, t;
    }
  }
};
const std::vector<Unknown> kLine{{0, -1e300, 1e300, 1, false}, {0, -1e300, 1e300, 1, false}};

TEST(Covariance, OfALineIsTheTextbooks) {
  const auto fit = minimise(kLine, Line(40, 1));
  const double n = 40, mean = 19.5, squares = n * (n * n - 1) / 12;
  EXPECT_NEAR(fit.covariance(1, 1), 1 / squares, 1e-9);
  EXPECT_NEAR(fit.covariance(0, 0), 1 / n + mean * mean / squares, 1e-9);
  EXPECT_NEAR(correlations(fit.covariance)(0, 1), -mean / std::sqrt(squares / n + mean * mean),
              1e-9);
}

TEST(Profile, OfALineIsTheNormalInterval) {
  const Line line(40, 1);
  const auto fit = minimise(kLine, line);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto p = profile_interval(kLine, line, fit, i);
    const double half = 1.959964 * std::sqrt(fit.covariance(k, k));
    EXPECT_FALSE(p.failed || p.open_below || p.open_above);
    EXPECT_NEAR(p.lower, fit.x[k] - half, 1e-3 * half);
    EXPECT_NEAR(p.upper, fit.x[k] + half, 1e-3 * half);
  }
}

TEST(Profile, IsOpenWhereTheDataAllowEverything) {
  // exp(-t / tau) seen over a time much shorter than tau: no upper end.
  const ResidualFunction slow = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                   Eigen::MatrixXd* J) {
    r.resize(20);
    if (J != nullptr) J->resize(20, 1);
    for (int i = 0; i < 20; ++i) {
      const double t = 0.01 * i, e = std::exp(-t / x[0]);
      r[i] = (e - std::exp(-t / 20)) / 0.05;
      if (J != nullptr) (*J)(i, 0) = e * t / (x[0] * x[0]) / 0.05;
    }
  };
  const std::vector<Unknown> start{{5, 0.01, 1e4, 1, true}};
  const auto p = profile_interval(start, slow, minimise(start, slow), 0);
  EXPECT_TRUE(p.open_above);
  EXPECT_EQ(p.upper, 1e4);
  EXPECT_FALSE(p.open_below);
  EXPECT_GT(p.lower, 0.1);
  EXPECT_LT(p.lower, 5);
}

TEST(Robust, WeightsAreThoseOfTheBooks) {
  EXPECT_EQ(robust_weight(RobustLoss::kHuber, 1), 1);
  EXPECT_NEAR(robust_weight(RobustLoss::kHuber, -2.69), 0.5, 1e-12);
  EXPECT_EQ(robust_weight(RobustLoss::kTukey, 5), 0);
  EXPECT_NEAR(robust_weight(RobustLoss::kTukey, 4.685 / 2), 0.5625, 1e-12);
}

TEST(Robust, WildReadingsDoNotPull) {
  double plain = 0, huber = 0, tukey = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Line line(40, seed, 5);
    plain += std::pow(minimise(kLine, line).x[1] - 0.5, 2) / 30;
    const auto h = minimise_robustly(kLine, line, RobustLoss::kHuber);
    const auto t = minimise_robustly(kLine, line, RobustLoss::kTukey);
    ASSERT_TRUE(h.fit.converged && t.fit.converged) << h.fit.message << t.fit.message;
    EXPECT_GE(t.discounted, 5);  // and 1 % of the good ones, beyond 2.5 deviations
    EXPECT_LE(t.discounted, 8);
    huber += std::pow(h.fit.x[1] - 0.5, 2) / 30;
    tukey += std::pow(t.fit.x[1] - 0.5, 2) / 30;
  }
  const double clean = 1 / (40 * (1600 - 1.0) / 12);  // variance of b without wild readings
  EXPECT_GT(plain, 20 * clean);
  EXPECT_LT(huber, 5 * clean);
  EXPECT_LT(tukey, 2 * clean);
}

TEST(Robust, ErrorsCoverTheTruthOnCleanAndWildData) {
  for (const int wild : {0, 4})
    for (const RobustLoss loss : {RobustLoss::kHuber, RobustLoss::kTukey}) {
      int covered = 0;
      for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const auto fit = minimise_robustly(kLine, Line(60, seed, wild), loss).fit;
        covered += std::abs(fit.x[1] - 0.5) < 1.96 * std::sqrt(fit.covariance(1, 1));
      }
      // Wild readings on one side leave Huber a bias, which no standard error knows.
      EXPECT_GT(covered, loss == RobustLoss::kHuber && wild > 0 ? 140 : 180) << wild;
    }
}

// Moore and Penrose's conditions for X = (J'J)^+, also where columns of J are alike.
TEST(NormalInverse, IsThatOfTheNormalEquations) {
  Random random(3);
  Eigen::MatrixXd J(40, 4);
  for (Eigen::Index i = 0; i < J.rows(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) J(i, k) = random.normal();
  J.col(3) = J.col(0) - 2 * J.col(1);
  for (const Eigen::Index columns : {3, 4}) {
    const Eigen::MatrixXd N = J.leftCols(columns).transpose() * J.leftCols(columns);
    const Eigen::MatrixXd X = normal_inverse(J.leftCols(columns));
    EXPECT_LT((N * X * N - N).norm(), 1e-10 * N.norm());
    EXPECT_LT((X * N * X - X).norm(), 1e-10 * X.norm());
    EXPECT_LT((N * X - X * N).norm(), 1e-10);
  }
}

// The matrix of n x n that the pseudo-inverse of the tall Jacobian works with would be 80 GB.
TEST(Robust, TakesNoMoreMemoryThanItsJacobian) {
  const auto fit = minimise_robustly(kLine, Line(100000, 1, 0), RobustLoss::kHuber).fit;
  ASSERT_TRUE(fit.converged);
  const double variance = 12 / std::pow(100000.0, 3);            // of the slope, at a noise of 1
  EXPECT_NEAR(fit.covariance(1, 1) / variance, 1 / 0.95, 0.02);  // Holland and Welsch's efficiency
}

TEST(BlindDirections, AreNamedInWords) {
  const std::vector<std::string> names{"E", "E1", "tau1"};
  const auto say = [&](std::vector<Unknown> u, const Eigen::MatrixXd& J) {
    const auto blind = blind_directions(u, names, J);
    return blind.empty() ? "" : blind.front().sentence;
  };
  const std::vector<Unknown> linear{{4, 0, 10}, {2, 0, 10}, {1, 0, 10}};
  Eigen::MatrixXd J = Eigen::MatrixXd::Random(30, 3) * 100;
  EXPECT_EQ(say(linear, J), "");
  J.col(1) = J.col(0);
  EXPECT_EQ(say(linear, J), "E and E1 enter only as their sum");
  J.col(1) = -J.col(0);
  EXPECT_EQ(say(linear, J), "E and E1 enter only as their difference");
  J.col(1) = 2 * J.col(0);  // d/dE of E E1 is E1 = 2, d/dE1 is E = 4
  EXPECT_EQ(say(linear, J), "E and E1 enter only as their product");
  J.col(1) = -2 * J.col(0);
  EXPECT_EQ(say(linear, J), "E and E1 enter only as their ratio");
  J.col(1) = Eigen::VectorXd::Random(30) * 100;
  J.col(2).setZero();
  EXPECT_EQ(say(linear, J), "tau1 has no effect that the data show");
  std::vector<Unknown> logarithmic = linear;
  for (Unknown& u : logarithmic) u.logarithmic = true, u.lower = 1e-3;
  J.col(2) = Eigen::VectorXd::Random(30) * 100;
  J.col(1) = J.col(0);
  EXPECT_EQ(say(logarithmic, J), "E and E1 enter only as their sum");
  EXPECT_EQ(blind_directions(linear, names, J.topRows(2)).size(), 1U);
}

TEST(EnoughData, IsTenAParameter) {
  EXPECT_TRUE(enough_data(100, 10));
  EXPECT_FALSE(enough_data(99, 10));
}

TEST(MultiStart, LeavesALocalValley) {
  // sin waves: (sin(x) - 1/2)^2 + (x / 20)^2 has a valley near every solution of sin x = 1/2.
  const ResidualFunction waves = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                    Eigen::MatrixXd* J) {
    r = Eigen::Vector2d(10 * (std::sin(x[0]) - 0.5), x[0] / 2);
    if (J == nullptr) return;
    *J = Eigen::Vector2d(10 * std::cos(x[0]), 0.5);
  };
  const std::vector<Unknown> start{{15, -20, 20, 1, false}};
  LeastSquaresOptions options;
  options.decrease_tolerance = 1e-9;
  EXPECT_GT(std::abs(minimise(start, waves, options).x[0]), 2);
  Random random(1);
  const auto starts = latin_hypercube_starts(start, 21, random);
  EXPECT_EQ(starts[0][0].value, 15);
  std::vector<int> cell(20, 0);  // one in each twentieth of the range
  for (std::size_t k = 1; k < starts.size(); ++k)
    ++cell[static_cast<std::size_t>((starts[k][0].value + 20) / 2)];
  EXPECT_EQ(cell, std::vector<int>(20, 1));
  const auto found = minimise_from_many(starts, waves, options);
  EXPECT_NEAR(found.best.x[0], 0.52, 0.02);
  EXPECT_GT(found.valleys, 3);
  EXPECT_LT(found.agreeing, found.converged);
}

TEST(Constrained, HoldsWhatBindsAndTheCovarianceKnows) {
  // x near (1, 2) with x0 - x1 >= 0: on the diagonal at 1.5, one direction free.
  const ResidualFunction near = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                   Eigen::MatrixXd* J) {
    r = x - Eigen::Vector2d(1, 2);
    if (J != nullptr) *J = Eigen::MatrixXd::Identity(2, 2);
  };
  const std::vector<Unknown> start{{0, -10, 10, 1, false}, {5, -10, 10, 1, false}};
  LinearConstraint c{{1, -1}, 0, 1e300};
  const auto result = minimise_constrained(start, {c}, near);
  ASSERT_TRUE(result.fit.converged) << result.fit.message;
  EXPECT_TRUE(result.active[0]);
  EXPECT_NEAR(result.fit.x[0], 1.5, 1e-6);
  EXPECT_NEAR(result.fit.x[1], 1.5, 1e-6);
  EXPECT_NEAR(result.fit.covariance(0, 0), 0.5, 1e-6);
  EXPECT_NEAR(result.fit.covariance(0, 1), 0.5, 1e-6);
  EXPECT_NEAR(result.fit.sum_of_squares, 0.5, 1e-6);
}

TEST(Constrained, RosenbrockOnAHalfPlane) {
  const ResidualFunction rosenbrock = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                         Eigen::MatrixXd* J) {
    r = Eigen::Vector2d(10 * (x[1] - x[0] * x[0]), 1 - x[0]);
    if (J == nullptr) return;
    J->resize(2, 2);
    *J << -20 * x[0], 10, -1, 0;
  };
  const std::vector<Unknown> start{{-1.2, -5, 5, 1, false}, {1, -5, 5, 1, false}};
  LeastSquaresOptions options;
  options.max_iterations = 1000;
  const auto whole = minimise_constrained(start, {}, rosenbrock, options);
  ASSERT_TRUE(whole.fit.converged) << whole.fit.message;
  EXPECT_NEAR(whole.fit.x[0], 1, 1e-6);
  // x + y <= 0: the least point is on the line, where y = -x leaves 100 (x + x^2)^2 + (1 - x)^2.
  const auto half = minimise_constrained(start, {{{1, 1}, -1e300, 0}}, rosenbrock, options);
  ASSERT_TRUE(half.fit.converged) << half.fit.message;
  EXPECT_TRUE(half.active[0]);
  const double x = half.fit.x[0];
  EXPECT_NEAR(x, -half.fit.x[1], 1e-6);
  EXPECT_NEAR(200 * (x + x * x) * (1 + 2 * x) - 2 * (1 - x), 0, 1e-4);
}

TEST(Constrained, ImpossibleConstraintsAreToldApart) {
  const ResidualFunction near = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                   Eigen::MatrixXd* J) {
    r = x;
    if (J != nullptr) *J = Eigen::MatrixXd::Identity(1, 1);
  };
  const auto result = minimise_constrained({{0, -1, 1, 1, false}}, {{{1}, 5, 1e300}}, near);
  EXPECT_FALSE(result.fit.converged);
  EXPECT_EQ(result.fit.message, "no point keeps all constraints");
}

}  // namespace
}  // namespace hapsim
