// Where a tool can be pressed, and which of these places first.
#include "plan/spread_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/tetmesh.h"
#include "support/block_mesh.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004, kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<PressablePlace> top() {
  const TetMesh block = test::block_mesh({0.09, 0.06, 0.03}, 3, 2, 1, 1);
  return pressable_places(body_boundary(block).surface, kRadius, M_PI / 4);
}

TEST(PressablePlaces, AreTheTopWithoutItsEdges) {
  const std::vector<PressablePlace> places = top();
  EXPECT_GT(places.size(), 100u);
  EXPECT_LE(places.size(), 500u);
  double least = 1, most = 0;
  for (const PressablePlace& p : places) {
    EXPECT_NEAR(p.point.z(), 0.03, 1e-12);
    EXPECT_NEAR(p.normal.z(), 1, 1e-12);
    least = std::min({least, p.point.x(), p.point.y(), 0.09 - p.point.x(), 0.06 - p.point.y()});
    most = std::max(most, p.point.x());
  }
  EXPECT_GE(least, kRadius);      // the disc stays on it
  EXPECT_LE(least, 3 * kRadius);  // and no more is given away
  EXPECT_GE(most, 0.09 - 3 * kRadius);
}

TEST(PressablePlaces, SteepSidesAreLeftOut) {
  const TetMesh block = test::block_mesh({0.09, 0.06, 0.03}, 3, 2, 1, 1);
  for (const PressablePlace& p :
       pressable_places(body_boundary(block).surface, kRadius, M_PI / 1.9))
    EXPECT_GT(p.normal.z(), -0.1);
}

TEST(SpreadPlaces, FillTheSurface) {
  const std::vector<PressablePlace> places = top();
  const std::vector<PressablePlace> six = spread_places(places, {}, 2 * kRadius, 6);
  ASSERT_EQ(six.size(), 6u);
  // Nowhere on it is a press far: a grid of 3 x 2 leaves 21 mm.
  double farthest = 0;
  for (const PressablePlace& p : places) {
    double nearest = 1;
    for (const PressablePlace& s : six) nearest = std::min(nearest, (s.point - p.point).norm());
    farthest = std::max(farthest, nearest);
  }
  std::printf("farthest from a press: %.1f mm\n", 1e3 * farthest);
  EXPECT_LT(farthest, 0.030);
}

TEST(SpreadPlaces, WhatWasPressedIsLeftAlone) {
  const std::vector<PressablePlace> places = top();
  std::vector<SeenPlace> seen;
  for (const PressablePlace& p : places)
    if (p.point.x() < 0.045) seen.push_back({p.point, kUnknown});
  for (const PressablePlace& p : spread_places(places, seen, 2 * kRadius, 3))
    EXPECT_GT(p.point.x(), 0.045);
}

TEST(SpreadPlaces, WhereTheStiffnessStandsOutIsLookedAtMore) {
  const std::vector<PressablePlace> places = top();
  const Vec3 odd(0.065, 0.03, 0.03);
  std::vector<SeenPlace> seen;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3 p(0.009 + 0.018 * i, 0.012 + 0.018 * j, 0.03);
      seen.push_back({p, 0.3 * std::exp(-(p - odd).squaredNorm() / 2e-4)});
    }
  const auto near = [&](const std::vector<PressablePlace>& chosen) {
    return std::count_if(chosen.begin(), chosen.end(),
                         [&](const PressablePlace& p) { return (p.point - odd).norm() < 0.02; });
  };
  const auto with = near(spread_places(places, seen, 2 * kRadius, 4));
  for (SeenPlace& s : seen) s.gain = kUnknown;
  const auto without = near(spread_places(places, seen, 2 * kRadius, 4));
  EXPECT_GT(with, without);
  EXPECT_GE(with, 2);
}

}  // namespace
}  // namespace hapsim
