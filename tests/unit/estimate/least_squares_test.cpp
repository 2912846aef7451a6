#include "estimate/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// y = a exp(-t / tau) + c, with unit noise after whitening.
struct Decay {
  std::vector<double> t, y;
  double noise = 0.01;
  void operator()(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    r.resize(static_cast<Eigen::Index>(t.size()));
    if (J != nullptr) J->resize(r.size(), 3);
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const double e = std::exp(-t[i] / x[1]);
      r[i] = (x[0] * e + x[2] - y[i]) / noise;
      if (J == nullptr) continue;
      (*J)(i, 0) = e / noise;
      (*J)(i, 1) = x[0] * e * t[i] / (x[1] * x[1]) / noise;
      (*J)(i, 2) = 1 / noise;
    }
  }
};

Decay make_decay(std::uint64_t seed) {
  Random random(seed);
  Decay d;
  for (int i = 0; i < 200; ++i) {
    d.t.push_back(0.01 * i);
    d.y.push_back(2 * std::exp(-d.t.back() / 0.4) + 0.5 + d.noise * random.normal());
  }
  return d;
}

const std::vector<Unknown> kStart{
    {1, -100, 100, 1, false}, {0.1, 1e-3, 100, 1, true}, {0, -100, 100, 1, false}};

TEST(LeastSquares, StandardErrorsCoverTheTruth) {
  int covered = 0;
  const int trials = 200;
  for (int seed = 1; seed <= trials; ++seed) {
    const auto result = minimise(kStart, make_decay(static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(result.converged) << result.message;
    covered += std::abs(result.x[1] - 0.4) < 1.96 * std::sqrt(result.covariance(1, 1));
  }
  EXPECT_GT(covered, 0.90 * trials);
  EXPECT_LT(covered, 0.99 * trials);
}

TEST(LeastSquares, HoldsAnUnknownAtItsBound) {
  std::vector<Unknown> start = kStart;
  start[2].lower = 0.6;
  start[2].value = 1;
  const auto result = minimise(start, make_decay(1));
  ASSERT_TRUE(result.converged) << result.message;
  EXPECT_EQ(result.x[2], 0.6);
  EXPECT_TRUE(result.at_bound[2]);
  EXPECT_EQ(result.covariance(2, 2), 0);
}

TEST(LeastSquares, NamesWhatTheDataDoNotSee) {
  // Two unknowns that only act as a sum.
  const auto residuals = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    r = Eigen::VectorXd::Constant(10, x[0] + x[1] - 3);
    if (J != nullptr) *J = Eigen::MatrixXd::Ones(10, 2);
  };
  const auto result = minimise({{0, -10, 10, 1, false}, {0, -10, 10, 1, false}}, residuals);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.x.sum(), 3, 1e-6);
  EXPECT_TRUE(result.undetermined[0] && result.undetermined[1]);
}

TEST(LeastSquares, LeavesWhatChangesNothing) {
  // The second unknown acts from 2 on only, as friction does from where a tip slips.
  const auto residuals = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    r = Eigen::VectorXd::LinSpaced(10, 1, 2) * x[0] - Eigen::VectorXd::Constant(10, 3);
    if (J == nullptr) return;
    *J = Eigen::MatrixXd::Zero(10, 2);
    J->col(0) = Eigen::VectorXd::LinSpaced(10, 1, 2);
  };
  const auto both = minimise({{0, -10, 10, 1, false}, {3, 2, 1000, 1, true}}, residuals);
  EXPECT_TRUE(both.converged);
  EXPECT_NEAR(both.x[0], 3 * 1.5 / (7.0 / 3 + 1.0 / 54), 1e-6);
  EXPECT_EQ(both.x[1], 3);
  EXPECT_TRUE(!both.undetermined[0] && both.undetermined[1]);
  const auto alone = minimise({{3, 2, 1000, 1, true}},
                              [](const Eigen::VectorXd&, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
                                r = Eigen::VectorXd::Ones(10);
                                if (J != nullptr) *J = Eigen::MatrixXd::Zero(10, 1);
                              });
  EXPECT_TRUE(alone.converged && alone.undetermined[0]);
  EXPECT_EQ(alone.x[0], 3);
}

TEST(LeastSquares, RosenbrockFromFarAway) {
  const auto residuals = [](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    r.resize(2);
    r << 10 * (x[1] - x[0] * x[0]), 1 - x[0];
    if (J == nullptr) return;
    J->resize(2, 2);
    *J << -20 * x[0], 10, -1, 0;
  };
  LeastSquaresOptions options;
  options.max_iterations = 500;
  options.decrease_tolerance = 1e-12;
  const auto result =
      minimise({{-1.2, -1e6, 1e6, 1, false}, {1, -1e6, 1e6, 1, false}}, residuals, options);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.x[0], 1, 1e-5);
  EXPECT_NEAR(result.x[1], 1, 1e-5);
}

}  // namespace
}  // namespace hapsim
