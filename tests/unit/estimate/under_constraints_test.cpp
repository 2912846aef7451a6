#include "estimate/under_constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "estimate/feasible.h"

using namespace hapsim;

namespace {

// Formulas in a, b, c: the unknowns in their order.
std::vector<SmoothConstraint> among(const std::string& text, Eigen::Index n) {
  std::vector<SmoothConstraint> result;
  for (const Relation& one : parse_relations(text, "--constrain")) {
    std::vector<Eigen::Index> columns;
    for (const std::string& name : one.difference.names()) columns.push_back(name[0] - 'a');
    result.push_back(
        {[f = one.difference, columns, n](const Eigen::VectorXd& x) {
           const Taylor small = f.at(x(columns));
           Taylor all{small.value, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
           all.slope(columns) = small.slope;
           all.curvature(columns, columns) = small.curvature;
           return all;
         },
         one.equality});
  }
  return result;
}

// r = x - target
ResidualFunction towards(const Eigen::VectorXd& target) {
  return [target](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    r = x - target;
    if (J != nullptr) *J = Eigen::MatrixXd::Identity(x.size(), x.size());
  };
}

}  // namespace

TEST(UnderConstraints, NearestPointOfALine) {
  const auto found =
      minimise_under({{3}, {1}}, among("a + b = 1; a <= 5", 2), towards(Eigen::Vector2d(3, 1)));
  ASSERT_TRUE(found.fit.converged) << found.fit.message;
  EXPECT_NEAR(found.fit.x[0], 1.5, 1e-12);
  EXPECT_NEAR(found.fit.x[1], -0.5, 1e-12);
  EXPECT_EQ(found.active, (std::vector<bool>{true, false}));
  // |r|^2 = (a + b - 4)^2 / 2 along the line: its slope by a + b is -3; without it |r| is 0.
  EXPECT_NEAR(found.multiplier[0], -3, 1e-9);
  EXPECT_NEAR(found.worth[0], found.fit.sum_of_squares, 1e-9);
  // Only a - b is free: variance 1/2 of each, and they go against each other.
  EXPECT_NEAR(found.fit.covariance(0, 0), 0.5, 1e-12);
  EXPECT_NEAR(found.fit.covariance(0, 1), -0.5, 1e-12);
  EXPECT_EQ(found.directions.cols(), 1);
}

TEST(UnderConstraints, NearestPointOfACircleAndOfAHyperbola) {
  const auto circle =
      minimise_under({{3}, {4}}, among("a^2 + b^2 <= 1", 2), towards(Eigen::Vector2d(3, 4)));
  ASSERT_TRUE(circle.fit.converged) << circle.fit.message;
  EXPECT_NEAR(circle.fit.x[0], 0.6, 1e-9);
  EXPECT_NEAR(circle.fit.x[1], 0.8, 1e-9);
  // Logarithmic unknowns: (t, 1/t) next to (2, 1) has t^4 - 2 t^3 + t - 1 = 0.
  const auto hyperbola = minimise_under({{2, 1e-6, 1e6, 1, true}, {1, 1e-6, 1e6, 1, true}},
                                        among("a*b = 1", 2), towards(Eigen::Vector2d(2, 1)));
  ASSERT_TRUE(hyperbola.fit.converged) << hyperbola.fit.message;
  const double t = hyperbola.fit.x[0];
  EXPECT_NEAR(std::pow(t, 4) - 2 * std::pow(t, 3) + t - 1, 0, 1e-6);
  EXPECT_NEAR(hyperbola.fit.x[1], 1 / t, 1e-12);
}

TEST(UnderConstraints, KeepsBoundsToo) {
  const auto found =
      minimise_under({{3, -10, 1.2}, {1}}, among("a + b <= 1", 2), towards(Eigen::Vector2d(3, 1)));
  ASSERT_TRUE(found.fit.converged);
  EXPECT_NEAR(found.fit.x[0], 1.2, 1e-12);
  EXPECT_NEAR(found.fit.x[1], -0.2, 1e-12);
  EXPECT_TRUE(found.fit.at_bound[0]);
  EXPECT_EQ(found.directions.cols(), 0);
  EXPECT_EQ(found.fit.covariance.norm(), 0);
}

// What the data hardly see decides as exactly what binds as what they see well.
TEST(UnderConstraints, BadlyScaledProblem) {
  const ResidualFunction bad = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                  Eigen::MatrixXd* J) {
    const Eigen::Vector3d weight(1e4, 1, 1e-3);
    r = weight.cwiseProduct(x - Eigen::Vector3d(1, 2, 3));
    if (J != nullptr) *J = weight.asDiagonal();
  };
  const auto found = minimise_under({{1}, {2}, {3}}, among("c <= b; a >= 0", 3), bad);
  ASSERT_TRUE(found.fit.converged);
  // c gives way, b by its share: weights 1 and 1e-6.
  EXPECT_NEAR(found.fit.x[0], 1, 1e-9);
  EXPECT_NEAR(found.fit.x[1], 2 + 1e-6 / (1 + 1e-6), 1e-8);
  EXPECT_NEAR(found.fit.x[2], found.fit.x[1], 1e-9);
}

// Far from linear, and much is left: exp(-b t) through what no exponential is.
TEST(UnderConstraints, ResidualsThatBend) {
  const ResidualFunction decay = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                    Eigen::MatrixXd* J) {
    constexpr int n = 20;
    r.resize(n);
    if (J != nullptr) J->resize(n, 2);
    for (int i = 0; i < n; ++i) {
      const double t = 0.2 * i, e = std::exp(-x[1] * t);
      r[i] = x[0] * e - 1 / (1 + t);
      if (J != nullptr) J->row(i) << e, -x[0] * t * e;
    }
  };
  const auto found =
      minimise_under({{1, 0, 10}, {0.5, 1e-3, 10, 1, true}}, among("a = 2*b", 2), decay);
  ASSERT_TRUE(found.fit.converged);
  // Along a = 2 b by golden section.
  double low = 0.1, high = 2;
  const auto value = [&](double b) {
    Eigen::VectorXd r;
    decay(Eigen::Vector2d(2 * b, b), r, nullptr);
    return r.squaredNorm();
  };
  for (int k = 0; k < 200; ++k) {
    const double g = (std::sqrt(5.0) - 1) / 2, p = high - g * (high - low),
                 q = low + g * (high - low);
    (value(p) < value(q) ? high : low) = value(p) < value(q) ? q : p;
  }
  EXPECT_NEAR(found.fit.x[1], low, 1e-6);
}

TEST(UnderConstraints, SaysWhereNothingKeepsThem) {
  const std::vector<Unknown> start{{3, 0, 4}, {1}, {1}};
  const auto constraints = among("c >= 7; a >= b + 2; b >= 3; c <= 9", 3);
  const auto found = minimise_under(start, constraints, towards(Eigen::Vector3d(1, 1, 1)));
  EXPECT_FALSE(found.fit.converged);
  EXPECT_EQ(found.fit.message, "no point keeps all constraints");
  const Conflict conflict = find_conflict(start, constraints);
  EXPECT_EQ(conflict.constraints, (std::vector<std::size_t>{1, 2}));
  EXPECT_TRUE(conflict.lower.empty());
  EXPECT_EQ(conflict.upper, (std::vector<std::size_t>{0}));
}

TEST(UnderConstraints, FindsAPointFarFromTheStart) {
  const std::vector<Unknown> start{{1, 1e-3, 1e9, 1, true}, {1, 1e-3, 1e9, 1, true}};
  const auto point = feasible_point(start, among("a*b = 1e6; a = 100*b", 2));
  ASSERT_TRUE(point.has_value());
  EXPECT_NEAR((*point)[0], 1e4, 1e-3);
  EXPECT_NEAR((*point)[1], 1e2, 1e-5);
}

TEST(UnderConstraints, AsManyEqualitiesAsUnknowns) {
  const auto found =
      minimise_under({{3}, {1}}, among("a = 2*b; a + b = 6", 2), towards(Eigen::Vector2d(0, 0)));
  ASSERT_TRUE(found.fit.converged);
  EXPECT_NEAR(found.fit.x[0], 4, 1e-9);
  EXPECT_NEAR(found.fit.x[1], 2, 1e-9);
}

// A term a exp(-b t) that is at first worth nothing at this b has worth at another: where a step
// takes a to its bound, b must not be lost.
TEST(UnderConstraints, ATermWithoutStiffnessDoesNotLoseItsTime) {
  constexpr int n = 40;
  const ResidualFunction two = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                  Eigen::MatrixXd* J) {
    r.resize(n);
    if (J != nullptr) J->resize(n, 4);
    for (int i = 0; i < n; ++i) {
      const double t = 0.1 * i, e1 = std::exp(-t / x[1]), e2 = std::exp(-t / x[3]);
      r[i] = x[0] * e1 + x[2] * e2 - 4 * std::exp(-t / 0.3) - 2 * std::exp(-t / 3);
      r[i] *= 100;
      if (J == nullptr) continue;
      J->row(i) << e1, x[0] * e1 * t / (x[1] * x[1]), e2, x[2] * e2 * t / (x[3] * x[3]);
      J->row(i) *= 100;
    }
  };
  const std::vector<Unknown> start{
      {4, 0, 100}, {0.3, 1e-3, 1e3, 1, true}, {2, 0, 100}, {3, 1e-3, 1e3, 1, true}};
  const auto found = minimise_under(start, among("a + c <= 4", 4), two);
  ASSERT_TRUE(found.fit.converged) << found.fit.message;
  EXPECT_TRUE(found.active[0]);
  // By a fine net over both times: forces are linear in a and c, of a + c = 4.
  double best = 1e300;
  for (int k = 0; k <= 150; ++k)
    for (int l = 0; l <= 150; ++l) {
      const double t1 = std::exp(std::log(0.02) + k * std::log(1e3) / 150),
                   t2 = std::exp(std::log(0.02) + l * std::log(1e3) / 150);
      double ee = 0, er = 0, rr = 0;
      for (int i = 0; i < n; ++i) {
        const double t = 0.1 * i, e = std::exp(-t / t1) - std::exp(-t / t2);
        const double rest = 4 * std::exp(-t / t2) - 4 * std::exp(-t / 0.3) - 2 * std::exp(-t / 3);
        ee += e * e, er += e * rest, rr += rest * rest;
      }
      const double a = ee > 0 ? std::clamp(-er / ee, 0.0, 4.0) : 0;
      best = std::min(best, 1e4 * (rr + 2 * a * er + a * a * ee));
    }
  EXPECT_LE(found.fit.sum_of_squares, best);
  EXPECT_LT(found.fit.iterations, 40);
}

// The constraint bends away from the goal, and the residuals bend down along it.
TEST(UnderConstraints, WhatBendsDownIsNoEnd) {
  const ResidualFunction wave = [](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                   Eigen::MatrixXd* J) {
    r = Eigen::Vector3d(x[0] - 3, x[1], 4 + std::cos(3 * x[1]));
    if (J == nullptr) return;
    *J = Eigen::MatrixXd::Zero(3, 2);
    (*J)(0, 0) = (*J)(1, 1) = 1;
    (*J)(2, 1) = -3 * std::sin(3 * x[1]);
  };
  const auto found = minimise_under({{0.5}, {0.1}}, among("a^2 + b^2 <= 4", 2), wave);
  ASSERT_TRUE(found.fit.converged) << found.fit.message;
  // Along the circle a = 2 cos s, b = 2 sin s.
  double best = 1e300;
  for (double s = 0; s < 1.5; s += 1e-5) {
    const double a = 2 * std::cos(s) - 3, b = 2 * std::sin(s), c = 4 + std::cos(3 * b);
    best = std::min(best, a * a + b * b + c * c);
  }
  EXPECT_NEAR(found.fit.sum_of_squares, best, 1e-9);
  EXPECT_LT(found.fit.iterations, 25);
}

// Residuals and constraints of chance, that bend as much as they rise: every end is kept, and no
// way that the active ones leave goes down (Karush, Kuhn and Tucker), nor does it bend down.
TEST(UnderConstraints, EveryEndKeepsTheConditionsOfAMinimum) {
  Random random(5);
  int binding = 0, ended = 0;
  constexpr int kProblems = 200;
  for (int problem = 0; problem < kProblems; ++problem) {
    const auto n = static_cast<Eigen::Index>(2 + random.integer(4));
    const auto rows = static_cast<Eigen::Index>(n + 3);
    const auto any = [&] { return 2 * random.uniform() - 1; };
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(rows, n, any),
                          B = Eigen::MatrixXd::NullaryExpr(rows, n, any);
    const Eigen::VectorXd target = 3 * Eigen::VectorXd::NullaryExpr(rows, any);
    const ResidualFunction residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                           Eigen::MatrixXd* J) {
      const Eigen::VectorXd bent = B * x;
      r = A * x + bent.array().sin().matrix() - target;
      if (J != nullptr) *J = A + bent.array().cos().matrix().asDiagonal() * B;
    };
    std::vector<Unknown> start(static_cast<std::size_t>(n), Unknown{0, -3, 3});
    std::vector<SmoothConstraint> constraints;
    for (std::size_t c = 0; c < 1 + random.integer(3); ++c) {
      const Eigen::MatrixXd C = Eigen::MatrixXd::NullaryExpr(n, n, any);
      const Eigen::MatrixXd Q = C + C.transpose();
      const Eigen::VectorXd q = 2 * Eigen::VectorXd::NullaryExpr(n, any);
      const Eigen::VectorXd at = Eigen::VectorXd::NullaryExpr(n, any);
      const double level = constraints.empty() ? q.dot(at) + at.dot(Q * at) / 2 : -random.uniform();
      constraints.push_back({[=](const Eigen::VectorXd& x) {
                               return Taylor{q.dot(x) + x.dot(Q * x) / 2 - level, q + Q * x, Q};
                             },
                             constraints.empty() && problem % 3 == 0});
    }
    const auto found = minimise_under(start, constraints, residuals);
    if (!found.fit.converged) {
      EXPECT_EQ(found.fit.message, "no point keeps all constraints") << problem;
      continue;
    }
    ++ended;
    const Eigen::VectorXd& x = found.fit.x;
    Eigen::VectorXd r;
    Eigen::MatrixXd J;
    residuals(x, r, &J);
    Eigen::VectorXd gradient = 2 * J.transpose() * r;
    const double size = 1 + gradient.norm();
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      const Taylor g = constraints[c].at(x);
      const double factor = found.multiplier[static_cast<Eigen::Index>(c)];
      EXPECT_GT(g.value, -1e-8 * (1 + g.slope.norm())) << problem;
      if (constraints[c].equality) {
        EXPECT_NEAR(g.value, 0, 1e-8 * (1 + g.slope.norm()));
      } else {
        EXPECT_GT(factor, -1e-5 * size) << problem;
      }
      binding += factor > 0;
      gradient -= factor * g.slope;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (x[i] < -3 + 1e-6) gradient[i] = std::min(gradient[i], 0.0);
      if (x[i] > 3 - 1e-6) gradient[i] = std::max(gradient[i], 0.0);
    }
    EXPECT_LT(gradient.norm(), 1e-5 * size) << problem << " " << found.fit.message;
    // No better within a little, along what is free.
    for (int k = 0; k < 30; ++k) {
      Eigen::VectorXd near = x;
      for (Eigen::Index d = 0; d < found.directions.cols(); ++d)
        near += 1e-3 * any() * found.directions.col(d);
      near = near.cwiseMax(-3).cwiseMin(3);
      double lagrangian = 0;
      Eigen::VectorXd there;
      residuals(near, there, nullptr);
      lagrangian = there.squaredNorm();
      for (std::size_t c = 0; c < constraints.size(); ++c)
        lagrangian -=
            found.multiplier[static_cast<Eigen::Index>(c)] * constraints[c].at(near).value;
      EXPECT_GT(lagrangian, found.fit.sum_of_squares - 1e-7 * size) << problem;
    }
  }
  EXPECT_GT(ended, kProblems / 2);
  EXPECT_GT(binding, kProblems / 2);
}
