#include "realtime/slip_ways.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

TEST(SlipWays, KeepToDepthsAtWhichAToolThatHoldsIsPressed) {
  for (const int depths : {5, 15}) {
    const std::vector<SlipMotion> all = planned_slip_ways({0, 1}, 0.4, depths, 1);
    ASSERT_GT(all.size(), static_cast<std::size_t>(kSlipFixed));
    const bool deep = depths > kSlipNear;
    for (std::size_t m = 0; m < all.size(); ++m)
      for (const Vec3& v : all[m].way) {
        const double parts = v[0] / kSlipPart;
        EXPECT_NEAR(parts, std::round(parts), 1e-9);
        EXPECT_GE(parts, 0.99);
        const bool drawn = m >= kSlipFixed;
        const double most = drawn && !deep ? kSlipWayDepth + kSlipPart / 2 : depths * kSlipStep;
        EXPECT_LE(v[0], most + 1e-9);
        if (drawn) EXPECT_LE(v.tail<2>().norm(), (deep ? 0.8 : 0.4) + 1e-9);
      }
  }
}

TEST(SlipWays, GoOnFromStepsThatThereAre) {
  for (const int depths : {1, 2, 8})
    for (const SlipMotion& m : planned_slip_ways({1, 0}, 0.15, depths, 1)) {
      EXPECT_TRUE(m.force.empty());
      if (m.after < 0) continue;
      EXPECT_GE(m.from, 1);
      EXPECT_LE(m.from, depths);
    }
}

TEST(SlipWays, OfEveryPlaceAreItsOwnAndTheSameAgain) {
  const auto drawn = [](std::uint64_t seed) {
    std::vector<Vec3> all;
    const std::vector<SlipMotion> ways = planned_slip_ways({0, 1}, 0.4, 5, seed);
    for (std::size_t m = kSlipFixed; m < ways.size(); ++m)
      all.insert(all.end(), ways[m].way.begin(), ways[m].way.end());
    return all;
  };
  EXPECT_EQ(drawn(1), drawn(1));
  EXPECT_NE(drawn(1), drawn(2));
}

// Around, in and out, and from corner to corner: kinds of which none is told by the others.
TEST(SlipWays, AreOfSeveralKinds) {
  const std::vector<SlipMotion> all = planned_slip_ways({0, 1}, 0.4, 5, 3);
  int around = 0, in_and_out = 0;
  for (std::size_t m = kSlipFixed; m < all.size(); ++m) {
    double turned = 0;
    int reversals = 0;
    for (std::size_t i = 2; i < all[m].way.size(); ++i) {
      const Vec3 was = all[m].way[i - 1], before = all[m].way[i - 2], now = all[m].way[i];
      if (was[0] == now[0])
        turned += std::atan2(was[1] * now[2] - was[2] * now[1], was.tail<2>().dot(now.tail<2>()));
      reversals += (now[0] - was[0]) * (was[0] - before[0]) < 0 ? 1 : 0;
    }
    around += std::abs(turned) > 6.3 ? 1 : 0;
    in_and_out += reversals >= 4 ? 1 : 0;
  }
  EXPECT_GE(around, 1);
  EXPECT_GE(in_and_out, 1);
}

}  // namespace
}  // namespace hapsim
