// A flat tool that slips at finite strain: the loop against elements that slip, at a place and
// along ways that were not pressed.
#include "realtime/strain_slip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "realtime/force_loop.h"
#include "realtime/strain_mesh.h"
#include "simulate/full_simulation.h"
#include "strained_body.h"
#include "support/allocations.h"

namespace hapsim {
namespace {

constexpr double kFriction = 0.4;

PreparedBody prepared(double friction) {
  PreparedBodyOptions options = test::strained_options();
  options.tolerance = 0.1;  // slip by coarse elements alone
  return PreparedBody(test::strained_mesh(), test::strained_model(0, friction), options);
}

const PreparedBody& slipping_body() {
  static const PreparedBody body = prepared(kFriction);
  return body;
}

TEST(SlipPresses, AreReadAsTheyWereWrittenAndNotWhereTheyAreDamaged) {
  SlipPresses presses;
  presses.friction = kFriction;
  presses.doubt = 0.01;
  presses.deepest = 0.3;
  presses.coarse_deepest = 0.45;
  presses.coarse_doubt = 0.03;
  presses.seen = 0.9;
  presses.motions = {{-1, 0, {{0.15, 0, 0}, {0.3, 0, 0}}, {{0.98, 0, 0}, {0.97, 0.01, 0}}},
                     {0, 2, {{0.15, 0, 0}}, {{0.9, 0, 0}}}};
  const std::optional<SlipPresses> back = SlipPresses::read(presses.bytes());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->bytes(), presses.bytes());
  EXPECT_EQ(back->motions[1].from, 2);
  EXPECT_EQ(back->motions[0].force[1], presses.motions[0].force[1]);
  std::string bytes = presses.bytes();
  bytes[40] ^= 1;
  EXPECT_FALSE(SlipPresses::read(bytes));
  EXPECT_FALSE(SlipPresses::read(bytes.substr(1)));
}

RimHeld linear_body(double depth, const Eigen::Vector2d& aside) {
  return {depth, 0.7 * aside, Eigen::Vector2d::Zero(), 0.7 * Eigen::Matrix2d::Identity()};
}

// A linear body under rings of which the forces are known, on the ways that places are pressed by.
SlipPlace place_of(const RimSlip& rim, double far_aside) {
  SlipPlace place;
  StrainSample& sample = place.sample;
  sample.frame.setIdentity();
  sample.K = Vec3(1, 0.7, 0.7).asDiagonal();
  sample.c.setZero();
  place.presses.friction = rim.friction;
  place.presses.deepest = 0.6;
  const std::vector<Vec3> corners[] = {
      {{0.6, 0, 0}, {0.15, 0, 0}},
      {{0.45, 0, 0}, {0.45, far_aside, 0}, {0.45, -far_aside / 2, 0}},
      {{0.6, 0.6 * far_aside, 0}, {0.15, 0, 0}},
      {{0.6, 0.3 * far_aside, 0}, {0.6, 0.3 * far_aside, far_aside}, {0.15, 0, far_aside}}};
  for (const std::vector<Vec3>& way : corners) {
    SlipMotion m;
    RimSlip::State state;
    Vec3 from = Vec3::Zero();
    for (const Vec3& to : way) {
      for (int i = 1; i <= 4; ++i) {
        const Vec3 v = from + i / 4.0 * (to - from);
        RimSlip::Force f;
        for (int k = 1; k <= 5; ++k) {
          const Vec3 w =
              m.way.empty() ? Vec3(k / 5.0 * v) : Vec3(m.way.back() + k / 5.0 * (v - m.way.back()));
          f = rim.step(w[0], w.tail<2>(), state,
                       [&](const Eigen::Vector2d& aside) { return linear_body(w[0], aside); });
        }
        m.way.push_back(v);
        m.force.emplace_back(f.normal / v[0], f.along[0] / v[0], f.along[1] / v[0]);
        double& seen = place.presses.seen;
        seen = std::max(seen, f.along.norm() / (rim.friction * f.normal));
      }
      from = to;
    }
    place.presses.motions.push_back(m);
  }
  return place;
}

RimSlip known_rings(double friction) {
  RimSlip rim;
  rim.friction = friction;
  rim.bound = {1.02, 1.02, 1, 0.96, 0.82};
  rim.drawn = {0.05, 0.2, 0.3, 0.5, 1.2};
  rim.drawn_more = {0.1, 0.2, 0.3, 0.4, 0.5};
  rim.returns.fill(0.8);
  rim.between.fill(0.15);
  rim.around = 0.2;
  return rim;
}

TEST(StrainSlip, RingsThatAreKnownAreFoundByTheirForces) {
  const StrainSlip found = fit_strain_slip({place_of(known_rings(0.4), 0.4)}, 2);
  EXPECT_LT(found.near.doubt, 0.01);
  EXPECT_GT(found.seen, 0.97);
  EXPECT_DOUBLE_EQ(found.near.deepest, 0.6);
}

TEST(StrainSlip, AToolThatHardlySlippedWasNotSeenToSlip) {
  const StrainSlip found = fit_strain_slip({place_of(known_rings(2), 0.1)}, 2);
  EXPECT_LT(found.seen, 0.5);
}

TEST(StrainSlip, SaysWhereNothingWasSeenOfTheTool) {
  StrainSlip slip;
  slip.near.rim.friction = kFriction;
  slip.near.deepest = 0.75;
  StrainSlip::State state, deep;
  state.deepest = 0.7;
  deep.deepest = 0.8;
  RimSlip::Force force;
  force.normal = 1;
  force.along = {0, 0.3 * kFriction};
  slip.seen = 0.5;
  EXPECT_TRUE(slip.within(state, force));
  EXPECT_FALSE(slip.within(deep, force));
  slip.deep.deepest = 0.9;  // coarse elements came there
  EXPECT_TRUE(slip.within(deep, force));
  force.along = {0, 0.6 * kFriction};  // more than it was seen to bear
  EXPECT_FALSE(slip.within(state, force));
  slip.seen = 0.97;  // it slipped as a whole, and bears no more
  EXPECT_TRUE(slip.within(state, force));
  force.slipped = {0.4, 0.4};
  EXPECT_FALSE(slip.within(state, force));
}

TEST(StrainSlip, IsTheMoreUncertainTheDeeperTheToolHasBeen) {
  StrainSlip slip;
  slip.near.doubt = 0.02;
  slip.near.deepest = 0.75;
  slip.deep.doubt = 0.04;
  slip.deep.deepest = 2.25;
  StrainSlip::State state;
  state.deepest = 0.7;
  EXPECT_DOUBLE_EQ(slip.doubt_of(state, 0.2), 0.02);
  state.deepest = 1.5;
  EXPECT_DOUBLE_EQ(slip.doubt_of(state, 0.2), 0.04);
  state.deepest = 2.55;
  EXPECT_NEAR(slip.doubt_of(state, 0.2), std::hypot(0.04, 0.06), 1e-12);
  state.deepest = 5;
  EXPECT_NEAR(slip.doubt_of(state, 0.2), std::hypot(0.04, 0.2), 1e-12);
  slip.deep.deepest = 0;  // not pressed deeper
  state.deepest = 1.05;
  EXPECT_NEAR(slip.doubt_of(state, 0.2), std::hypot(0.02, 0.06), 1e-12);
}

// From rings to others the force has no step, and what has slipped is kept when it is stored.
TEST(StrainSlip, GoesOverToTheRingsOfDeepPressesWithoutAStep) {
  StrainSlip slip;
  slip.near.rim = slip.deep.rim = known_rings(kFriction);
  slip.near.deepest = 0.5;
  slip.deep.deepest = 2;
  slip.deep.rim.drawn.fill(0.1);
  StrainSlip::State state;
  RimSlip::State near;
  double before = 0, most = 0;
  for (int i = 1; i <= 200; ++i) {
    const double d = 0.005 * i;
    const Eigen::Vector2d aside(0.1 * d, 0);
    const auto held = [&](const Eigen::Vector2d& way) { return linear_body(d, way); };
    const double force = slip.step(d, aside, state, held).normal;
    const double alone = slip.near.rim.step(d, aside, near, held).normal;
    if (d <= 0.5) EXPECT_EQ(force, alone);
    most = std::max(most, std::abs(force - before - 0.005));
    before = force;
    std::array<double, StrainSlip::State::kNumbers> numbers;
    state.store(numbers.data());
    state = StrainSlip::State::load(numbers.data());
  }
  EXPECT_LT(most, 0.005);
  EXPECT_EQ(state.deepest, 1);
  const auto held = [&](const Eigen::Vector2d& way) { return linear_body(1, way); };
  EXPECT_GT(std::abs(before - slip.near.rim.step(1, {0.1, 0}, near, held).normal), 0.005);
  slip.step(-0.1, {0.1, 0}, state, held);  // it has left, and comes down anew
  EXPECT_EQ(state.deepest, 0);
  EXPECT_EQ(state.deep.slip, state.near.slip);
}

// In and aside, aside alone as far as it slips, back, and out.
std::vector<Vec3> way() {
  std::vector<Vec3> all;
  for (int i = 1; i <= 4; ++i) all.emplace_back(0.04 * i, 0.025 * i, -0.15 * i);
  for (int i = 1; i <= 3; ++i) all.emplace_back(0.16 + 0.13 * i, 0.1, -0.6);
  for (int i = 1; i <= 3; ++i) all.emplace_back(0.55 - 0.08 * i, 0.1, -0.6);
  for (int i = 3; i >= 2; --i) all.emplace_back(0.31, 0.1, -0.15 * i);
  return all;
}

TEST(StrainSlip, TheLoopIsTheElementsThatSlipAndSaysHowWell) {
  const PreparedBody& body = slipping_body();
  ASSERT_TRUE(body.large_strain()->slip());
  const Vec3 at(0.052, 0.047, 0.06);
  const TetMesh mesh = test::strained_mesh();
  const ContactBase base = make_contact_base(mesh);
  FullPress elements(mesh, test::strained_model(0, kFriction), at, test::kStrainedRadius,
                     strain_elements(base, 0.5));
  FullPress bonded(mesh, test::strained_model(), at, test::kStrainedRadius,
                   strain_elements(base, 0.5));
  const PreparedBody rough = prepared(0);
  ForceLoop loop(body), held(rough);
  // The contact's stiffness has errors of its own, which are not those of slip.
  const SurfaceSide side = body.distance().at(at);
  const Vec3 n = side.normal;
  const double ratio = n.dot(body.facts().at(side.face, side.point, n).contact.K * n) /
                       n.dot(*bonded.stiffness() * n);
  loop.begin(at);
  held.begin(at);
  double worst = 0, worst_held = 0, peak = 0;
  int covered = 0, rows = 0;
  double t = 0;
  for (const Vec3& v : way()) {
    const Vec3 u = test::kStrainedRadius * v;
    const Vec3 truth = ratio * elements.step(u, 0), f = loop.press(t += 0.1, u);
    const Vec3 stuck = held.press(t, u);
    peak = std::max(peak, truth.norm());
    const double off = (f - truth).norm() / truth.norm();
    worst = std::max(worst, off);
    worst_held = std::max(worst_held, (stuck - truth).norm() / truth.norm());
    covered += off < 1.96 * loop.uncertainty() ? 1 : 0;
    ++rows;
    EXPECT_EQ(loop.beyond() & kBeyondLaw, 0);
  }
  std::printf("off at most %.2f %%, a held tool %.2f %%; covered %d of %d\n", 100 * worst,
              100 * worst_held, covered, rows);
  EXPECT_LT(worst, 0.08);
  EXPECT_GT(worst_held, 0.2);
  EXPECT_GE(covered, rows - 1);
}

TEST(StrainSlip, StepsAreOfNoRateGoOnFromAStateAndAllocateNothing) {
  const PreparedBody& body = slipping_body();
  ForceLoop coarse(body), fine(body), later(body);
  coarse.begin({0.052, 0.047, 0.06});
  fine.begin({0.052, 0.047, 0.06});
  Vec3 before = Vec3::Zero();
  double t = 0;
  for (const Vec3& v : way()) {
    const Vec3 u = test::kStrainedRadius * v;
    coarse.press(t + 0.05, 0.5 * (before + u));
    const Vec3 f = coarse.press(t + 0.1, u);
    Vec3 g = Vec3::Zero();
    const long allocated = test::allocations;
    for (int k = 1; k <= 20; ++k) g = fine.press(t + 0.005 * k, before + k / 20.0 * (u - before));
    EXPECT_EQ(test::allocations, allocated);
    EXPECT_LT((f - g).norm(), 0.03 * f.norm());
    later.restore(fine.state());
    EXPECT_EQ(later.press(t + 0.11, u), fine.press(t + 0.11, u));
    before = u;
    t += 0.2;
  }
}

// Where it has slid by more than half its radius the contact is elsewhere than the place.
TEST(StrainSlip, WhatSlidesFarIsSaidToBeBeyond) {
  const PreparedBody& body = slipping_body();
  ForceLoop loop(body);
  loop.begin({0.052, 0.047, 0.06});
  for (int i = 0; i <= 100; ++i) {
    const double aside = 0.01 * std::max(0, i - 20);
    loop.press(1e-3 * i, test::kStrainedRadius * Vec3(aside, 0, -0.02 * std::min(i, 20)));
    EXPECT_TRUE(aside >= 0.4 || (loop.beyond() & kBeyondLaw) == 0) << i;
  }
  loop.press(0.101, test::kStrainedRadius * Vec3(1.3, 0, -0.4));
  EXPECT_NE(loop.beyond() & kBeyondLaw, 0);
}

// What slipped deeper than it was pressed acts on the way out too.
TEST(StrainSlip, AToolThatHasBeenDeeperIsBeyondUntilItLeaves) {
  const PreparedBody& body = slipping_body();
  ForceLoop loop(body);
  loop.begin({0.052, 0.047, 0.06});
  double t = 0;
  const auto press = [&](double depth) {
    loop.press(t += 0.01, test::kStrainedRadius * Vec3(0, 0, -depth));
    return (loop.beyond() & kBeyondLaw) != 0;
  };
  const double deepest = body.large_strain()->slip()->deepest();
  EXPECT_FALSE(press(0.5 * deepest));
  const double before = loop.uncertainty();
  EXPECT_TRUE(press(deepest + 0.3));
  EXPECT_TRUE(press(0.5 * deepest));
  EXPECT_GT(loop.uncertainty(), before);
  press(-0.1);
  EXPECT_FALSE(press(0.5 * deepest));
  EXPECT_NEAR(loop.uncertainty(), before, 0.01 * before);
}

// Whatever way the tool goes.
TEST(StrainSlip, BearsNoMoreSidewaysThanCoulombAllows) {
  const PreparedBody& body = slipping_body();
  ForceLoop loop(body);
  loop.begin({0.047, 0.055, 0.06});
  const Vec3 n = body.distance().at({0.047, 0.055, 0.06}).normal;
  for (int i = 0; i < 400; ++i) {
    const double s = 0.01 * i;
    const Vec3 f = loop.press(
        1e-3 * i, test::kStrainedRadius * Vec3(0.5 * std::sin(3 * s), 0.4 * std::sin(2 * s + 1),
                                               -0.9 * std::sin(0.8 * s)));
    const double along = f.dot(n);
    EXPECT_LE((f - along * n).norm(), kFriction * std::max(0.0, along) * (1 + 1e-9) + 1e-12);
  }
}

}  // namespace
}  // namespace hapsim
