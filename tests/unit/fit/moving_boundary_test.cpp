// What a curve between two regions does to a place, and its derivatives.
#include "fit/moving_boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// A wave across a block, as a level on places 25 mm apart.
struct Wave {
  std::vector<Eigen::Vector2d> places;
  RegionCurve curve;
  Wave() {
    std::vector<double> height;
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 8; ++j) {
        places.emplace_back(0.01 + 0.025 * i, 0.01 + 0.025 * j);
        height.push_back(places.back().y() - 0.1 - 0.01 * std::sin(50 * places.back().x()));
      }
    curve.level = PlanLevel(places, 12);
    const Eigen::Map<const Eigen::VectorXd> values(height.data(), 40);
    curve.theta = curve.level.fitted(places, values, 1e-3);
    curve.bend = 0.2;
  }
};

TEST(MovingCurve, TheStifferRegionIsWhereTheLevelIsPositive) {
  const Wave wave;
  const MovingCurve moving(wave.curve, wave.places, 0.05);
  const auto above = moving.at({0.06, 0.15}, wave.curve.theta, 0.004);
  EXPECT_EQ(above.left, 1);
  EXPECT_EQ(above.right, 0);
  EXPECT_EQ(above.share, 1);
  EXPECT_EQ(moving.at({0.06, 0.05}, wave.curve.theta, 0.004).share, 0);
}

// On the curve; beside it the distance leaves out how its own slope changes.
TEST(MovingCurve, ItsDerivativesAreDifferences) {
  const Wave wave;
  const MovingCurve moving(wave.curve, wave.places, 0.05);
  const double width = 0.01, h = 1e-7;
  for (const double x : {0.02, 0.05, 0.09}) {
    double low = 0.05, high = 0.15;
    for (int k = 0; k < 50; ++k)
      (wave.curve.region({x, 0.5 * (low + high)}) == 1 ? high : low) = 0.5 * (low + high);
    const Eigen::Vector2d p(x, low);
    const auto here = moving.at(p, wave.curve.theta, width);
    EXPECT_NEAR(here.share, 0.5, 1e-6);
    for (Eigen::Index k = 0; k < wave.curve.theta.size(); ++k) {
      Eigen::VectorXd more = wave.curve.theta, less = wave.curve.theta;
      more[k] += h, less[k] -= h;
      const double difference =
          (moving.at(p, more, width).share - moving.at(p, less, width).share) / (2 * h);
      EXPECT_NEAR(here.by[k], difference, 1e-4 * (1 + std::abs(difference)));
    }
  }
}

// The last row, of the mean slope, leaves out how its weights change with the curve.
TEST(MovingCurve, WhatIsKnownOfTheModesHasItsDerivatives) {
  const Wave wave;
  const MovingCurve moving(wave.curve, wave.places, 0.05);
  Eigen::VectorXd r, more_r, less_r;
  Eigen::MatrixXd J, unused;
  moving.known(wave.curve.theta, r, J);
  ASSERT_EQ(r.size(), wave.curve.theta.size() - PlanLevel::kPlane + 1);
  const double h = 1e-6;
  for (Eigen::Index k = PlanLevel::kPlane; k < wave.curve.theta.size(); ++k) {
    Eigen::VectorXd more = wave.curve.theta, less = wave.curve.theta;
    more[k] += h, less[k] -= h;
    moving.known(more, more_r, unused);
    moving.known(less, less_r, unused);
    const auto modes = r.size() - 1;
    EXPECT_LT((J.col(k) - (more_r - less_r) / (2 * h)).head(modes).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace hapsim
