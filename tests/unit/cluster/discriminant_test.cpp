#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "cluster/class_boundary.h"
#include "cluster/pca.h"
#include "cluster/qda.h"

namespace hapsim {
namespace {

TEST(PrincipalComponents, FindTheAxesOfAnEllipse) {
  Random random(3);
  Eigen::MatrixXd x(4000, 2);
  for (int i = 0; i < x.rows(); ++i) {
    const double a = 3 * random.normal(), b = random.normal();
    x.row(i) << 5 + 0.6 * a - 0.8 * b, 0.8 * a + 0.6 * b;
  }
  const PrincipalComponents pc = principal_components(x);
  EXPECT_NEAR(pc.axes(0, 0), 0.6, 0.02);
  EXPECT_NEAR(pc.axes(1, 0), 0.8, 0.02);
  EXPECT_NEAR(pc.variance[0], 9, 0.6);
  EXPECT_NEAR(pc.variance[1], 1, 0.1);
  const Eigen::MatrixXd q = project(pc, x, 2);
  EXPECT_NEAR(q.col(0).dot(q.col(1)) / q.rows(), 0, 1e-9);
  EXPECT_NEAR(q.col(0).squaredNorm() / (q.rows() - 1.0), pc.variance[0], 1e-9);
  EXPECT_NEAR(project_errors(pc, Eigen::MatrixXd::Constant(1, 2, 0.1), 1)(0, 0), 0.1, 1e-12);
}

// Points with exactly the wanted mean and covariance diag(sx^2, sy^2): the corners of a rectangle.
void add_class(double mx, double my, double sx, double sy, int k, Eigen::MatrixXd& points,
               std::vector<int>& label) {
  const double f = std::sqrt(0.75);  // four samples, n - 1 = 3
  for (const double u : {-1.0, 1.0})
    for (const double v : {-1.0, 1.0}) {
      points.conservativeResize(points.rows() + 1, 2);
      points.row(points.rows() - 1) << mx + f * u * sx, my + f * v * sy;
      label.push_back(k);
    }
}

TEST(Qda, PosteriorOfTwoNormals) {
  Eigen::MatrixXd points(0, 2);
  std::vector<int> label;
  add_class(0, 0, 1, 1, 0, points, label);
  add_class(4, 0, 2, 1, 1, points, label);
  const Qda qda(points, label, 2, {});
  ASSERT_FALSE(qda.singular());
  const Eigen::Vector2d x(1.5, 0.5);
  const double g0 = std::log(0.5) - std::log(2 * std::numbers::pi) - 0.5 * (1.5 * 1.5 + 0.25);
  const double g1 =
      std::log(0.5) - std::log(2 * std::numbers::pi * 2) - 0.5 * (2.5 * 2.5 / 4 + 0.25);
  EXPECT_NEAR(qda.log_joint(x)[0], g0, 1e-12);
  EXPECT_NEAR(qda.log_joint(x)[1], g1, 1e-12);
  EXPECT_NEAR(qda.log_posterior(x).array().exp().sum(), 1, 1e-12);
  EXPECT_NEAR(qda.log_posterior(x)[1], -std::log1p(std::exp(g0 - g1)), 1e-12);
}

TEST(Qda, PriorsAreTheSharesOfTheSamples) {
  Eigen::MatrixXd points(0, 2);
  std::vector<int> label;
  add_class(-1, 0, 1, 1, 0, points, label);
  add_class(1, 0, 1, 1, 1, points, label);
  add_class(1, 0, 1, 1, 1, points, label);
  // n - 1 = 7 for eight points: the second class's covariance is 6/7 of what four have; pooled
  // away.
  const Qda qda(points, label, 2, {1, 0});
  const Eigen::Vector2d middle(0, 0);
  EXPECT_NEAR(qda.log_joint(middle)[1] - qda.log_joint(middle)[0], std::log(2.0), 1e-12);
}

TEST(Qda, FewOrCollinearSamplesAreRegularised) {
  Eigen::MatrixXd points(5, 2);
  points << 0, 0, 1, 0, 2, 0, 5, 0, 6, 0;
  const std::vector<int> label{0, 0, 0, 1, 1};
  EXPECT_TRUE(Qda(points, label, 2, {}).singular());
  const Qda qda = choose_qda(points, label, 2);
  ASSERT_FALSE(qda.singular());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(qda.classify(points.row(i).transpose()), label[i]);
}

TEST(ClassBoundary, ACircleIsFoundToAThousandthOfACell) {
  const auto inside = [](const Eigen::Vector2d& p) { return p.norm() < 0.4 ? 0 : 1; };
  const auto lines = class_boundaries(inside, {-1, -1}, {1, 1}, 20000);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].points.front(), lines[0].points.back());
  EXPECT_NEAR(length(lines[0]), 0.8 * std::numbers::pi, 2e-3);
  for (const auto& p : lines[0].points) EXPECT_NEAR(p.norm(), 0.4, 2e-5);
  EXPECT_NEAR(distance_to(lines, {0, 0}), 0.4, 1e-4);
  const auto keys = key_points(lines[0], 9);
  ASSERT_EQ(keys.size(), 9U);
  EXPECT_NEAR((keys[4] - keys[0]).norm(), 0.8, 1e-3);
}

TEST(ClassBoundary, ThreeSectorsMeetInAPoint) {
  const auto sector = [](const Eigen::Vector2d& p) {
    const double angle = std::atan2(p.y(), p.x());
    return angle < -2 ? 0 : angle < 0.3 ? 1 : angle < 2.5 ? 2 : 0;
  };
  const auto lines = class_boundaries(sector, {-1, -1}, {1, 1}, 20000);
  ASSERT_EQ(lines.size(), 3U);
  for (const BoundaryLine& line : lines) {
    EXPECT_LT(std::min(line.points.front().norm(), line.points.back().norm()), 0.02);
    EXPECT_GT(length(line), 0.9);
  }
}

TEST(ClassBoundary, NothingOutsideTheDomainAndNothingWithOneClass) {
  const auto half = [](const Eigen::Vector2d& p) { return p.y() > 0.5 ? -1 : p.x() > 0 ? 1 : 0; };
  const auto lines = class_boundaries(half, {-1, -1}, {1, 1}, 5000);
  ASSERT_EQ(lines.size(), 1U);
  for (const auto& p : lines[0].points) EXPECT_LE(p.y(), 0.5);
  EXPECT_TRUE(
      class_boundaries([](const Eigen::Vector2d&) { return 0; }, {-1, -1}, {1, 1}, 5000).empty());
}

}  // namespace
}  // namespace hapsim
