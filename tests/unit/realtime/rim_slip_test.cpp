// Rings that slip under a flat tool: against what is known of contacts with friction.
#include "realtime/rim_slip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "base/vec3.h"
#include "support/allocations.h"

namespace hapsim {
namespace {

constexpr double kNormal = 1, kSideways = 0.7;  // of a linear body

RimSlip rings(double friction, double drawn) {
  RimSlip rim;
  rim.friction = friction;
  rim.bound.fill(1);
  for (std::size_t j = 0; j < RimSlip::kRings; ++j) {
    rim.drawn[j] = drawn * static_cast<double>(j);
    if (j > 0) rim.between[j - 1] = 0.2;
  }
  rim.returns.fill(1);
  rim.around = 0.1;
  return rim;
}

// Depth, and ways aside; the force in the same axes.
Vec3 go(const RimSlip& rim, const Vec3& v, RimSlip::State& state) {
  const RimSlip::Force f =
      rim.step(v[0], v.tail<2>(), state, [&](const Eigen::Vector2d& way) -> RimHeld {
        return {kNormal * v[0], kSideways * way, Eigen::Vector2d::Zero(),
                kSideways * Eigen::Matrix2d::Identity()};
      });
  return {f.normal, f.along[0], f.along[1]};
}

std::vector<Vec3> wander() {
  std::vector<Vec3> all;
  for (int i = 1; i <= 200; ++i) {
    const double t = 0.03 * i;
    all.emplace_back(0.4 * std::abs(std::sin(t)), 0.3 * std::sin(1.7 * t), 0.3 * std::sin(2.3 * t));
  }
  return all;
}

// Pressure and traction of a rigid flat punch have one shape, so that it holds everywhere until it
// slips everywhere (Cattaneo 1938, Mindlin 1949; Johnson, Contact Mechanics, 1985, 7.2).
TEST(RimSlip, AFlatPunchHoldsUntilItSlipsAsAWhole) {
  const RimSlip rim = rings(0.4, 0);
  RimSlip::State state;
  go(rim, {0.5, 0, 0}, state);
  for (int i = 1; i <= 20; ++i) {
    const double aside = 0.02 * i;
    const Vec3 f = go(rim, {0.5, aside, 0}, state);
    EXPECT_NEAR(f[1], std::min(kSideways * aside, 0.4 * 0.5), 2e-4);
    EXPECT_NEAR(f[0], 0.5, 1e-6);
  }
  const Vec3 back = go(rim, {0.5, 0.3, 0}, state);
  EXPECT_NEAR(back[1], 0.2 - 0.1 * kSideways, 2e-4);
}

TEST(RimSlip, WithoutSlipItIsTheToolThatHolds) {
  const RimSlip rim = rings(1e3, 0.2);
  RimSlip::State state;
  for (const Vec3& v : wander()) {
    const Vec3 f = go(rim, v, state);
    if (v[0] < 0.01) continue;
    EXPECT_NEAR((f - Vec3(kNormal * v[0], kSideways * v[1], kSideways * v[2])).norm(), 0, 1e-6);
  }
}

// A rim that is drawn inwards slips on the way in, and the other way out; what bears sideways is
// less for it.
TEST(RimSlip, ARimThatIsDrawnBearsLessAndLessStillOut) {
  const RimSlip rim = rings(0.3, 0.25);
  RimSlip::State state;
  for (int i = 1; i <= 10; ++i) {
    const Vec3 f = go(rim, {0.05 * i, 0, 0}, state);
    EXPECT_LT(f[0], 0.995 * 0.05 * i);
    EXPECT_NEAR(f.tail<2>().norm(), 0, 1e-4);
  }
  RimSlip::State aside = state;
  const Vec3 sideways = go(rim, {0.5, 0.02, 0}, aside);
  EXPECT_LT(sideways[1], 0.99 * kSideways * 0.02);
  RimSlip::State in;
  for (int i = 1; i <= 4; ++i) go(rim, {0.05 * i, 0, 0}, in);
  const double way_in = go(rim, {0.25, 0, 0}, in)[0];
  for (int i = 9; i >= 6; --i) go(rim, {0.05 * i, 0, 0}, state);
  EXPECT_LT(go(rim, {0.25, 0, 0}, state)[0], 0.99 * way_in);
}

TEST(RimSlip, BearsNoMoreThanCoulombAllowsAndDissipates) {
  for (const double friction : {0.1, 0.4, 0.8}) {
    const RimSlip rim = rings(friction, 0.2);
    RimSlip::State state;
    double work = 0;
    Vec3 before = Vec3::Zero(), last = Vec3::Zero();
    for (int round = 0; round < 2; ++round) {
      work = 0;
      for (int i = 0; i <= 400; ++i) {  // the second time round a closed way
        const double t = 2 * std::acos(-1.0) * i / 400;
        const Vec3 v(0.4 - 0.1 * std::cos(t), 0.3 * std::sin(t), 0.2 * std::sin(2 * t));
        const Vec3 f = go(rim, v, state);
        EXPECT_LE(f.tail<2>().norm(), friction * f[0] * (1 + 1e-12));
        if (i > 0) work += 0.5 * (f + last).dot(v - before);
        before = v;
        last = f;
      }
    }
    EXPECT_GT(work, 0);
  }
}

TEST(RimSlip, IsOfNoRateTurnsWithTheMotionAndAllocatesNothing) {
  const RimSlip rim = rings(0.4, 0.2);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.4).toRotationMatrix();
  RimSlip::State coarse, fine, turned;
  Vec3 before = Vec3::Zero();
  const std::vector<Vec3> way = wander();
  const long allocated = test::allocations;
  for (const Vec3& v : way) {
    const Vec3 f = go(rim, v, coarse);
    Vec3 g = Vec3::Zero();
    for (int k = 1; k <= 8; ++k) g = go(rim, before + k / 8.0 * (v - before), fine);
    Vec3 w = v;
    w.tail<2>() = turn * v.tail<2>();
    Vec3 h = go(rim, w, turned);
    h.tail<2>() = turn.transpose() * h.tail<2>();
    before = v;
    if (v[0] < 0.05) continue;
    EXPECT_LT((f - g).norm(), 0.02 * f.norm());
    EXPECT_LT((f - h).norm(), 0.02 * f.norm());
  }
  EXPECT_EQ(test::allocations, allocated);
}

}  // namespace
}  // namespace hapsim
