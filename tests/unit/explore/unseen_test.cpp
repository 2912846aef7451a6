// What places that were left out say of those that nobody has pressed.
#include <gtest/gtest.h>

#include <cmath>

#include "explore/goals.h"

namespace hapsim {
namespace {

SeenPlace seen(double x) {
  return {{x, 0, 0}, 0};
}
PressablePlace place(double x) {
  return {{x, 0, 0}, Vec3::UnitZ()};
}

TEST(Unseen, APlaceStandsForItsShareOfTheSurface) {
  // A tenth of the surface is foretold to five times the noise, the rest to the noise.
  const Unseen mixed = unseen_of({{0.01, 0.25}, {1, 1}, 0.1}, {9, 1});
  EXPECT_NEAR(mixed.times_noise, std::sqrt(0.9 + 0.1 * 25), 1e-12);
  EXPECT_NEAR(mixed.share_of_force, std::sqrt(0.1 * 0.24), 1e-12);
  EXPECT_NEAR(unseen_of({{0.09, 0.09}, {4, 1}, 0.1}, {1, 7}).times_noise, 3, 1e-12);
  EXPECT_TRUE(std::isnan(unseen_of({}, {}).times_noise));
}

TEST(Unseen, DoubtIsLargestWhereTheOthersForetoldWorst) {
  const std::vector<SeenPlace> pressed{seen(0), seen(0.02), seen(0.04), seen(0.06)};
  const std::vector<double> doubt =
      doubt_at({place(0.01), place(0.03), place(0.05)}, pressed, {{1, 16, 16, 1}, {9, 9, 9, 9}, 1});
  EXPECT_GT(doubt[1], doubt[0]);
  EXPECT_GT(doubt[1], doubt[2]);
  EXPECT_NEAR(doubt[0], doubt[2], 1e-12);
  EXPECT_GT(doubt[0], 0);
}

TEST(Unseen, WhereAllIsForetoldToTheNoiseNoPlaceCountsMore) {
  const std::vector<SeenPlace> pressed{seen(0), seen(0.02)};
  EXPECT_EQ(doubt_at({place(0.01), place(0.03)}, pressed, {{0.8, 1}, {9, 9}, 1}),
            (std::vector<double>{1, 1}));
}

TEST(Unseen, WhatMeshAndShapeLeaveNoPressTakesAway) {
  EXPECT_TRUE(unseen_state({2, false}, {1.9, 0.03}, 0.01).reached);
  EXPECT_FALSE(unseen_state({2, false}, {2.4, 0.03}, 0.01).unreachable);
  EXPECT_TRUE(unseen_state({2, false}, {2.4, 0.008}, 0.01).unreachable);
  EXPECT_TRUE(unseen_state({0.05, true}, {9, 0.03}, 0.01).reached);
}

}  // namespace
}  // namespace hapsim
