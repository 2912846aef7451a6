// A flat tool that slips at finite strain: the loop against elements that slip, at a place and
// along ways that were not pressed.
#include "realtime/strain_slip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "realtime/force_loop.h"
#include "realtime/strain_mesh.h"
#include "simulate/full_simulation.h"
#include "strained_body.h"
#include "support/allocations.h"

namespace hapsim {
namespace {

constexpr double kFriction = 0.4;

const PreparedBody& slipping_body() {
  static const PreparedBody body = [] {
    PreparedBodyOptions options = test::strained_options();
    options.tolerance = 0.1;  // slip by coarse elements alone
    return PreparedBody(test::strained_mesh(), test::strained_model(0, kFriction), options);
  }();
  return body;
}

StrainSlip some_slip() {
  StrainSlip s;
  s.friction = kFriction;
  s.reached = 3;
  s.straight = {0.98, 0.97, 0.95};
  s.sliding = {0.96, 0.94, 0.91};
  s.doubt = {0.01, 0.02, 0.03};
  s.retreat = {0.04, 0.04, 0.03, 0.02, 0.02, 0.01};
  s.retreat_from = s.aside_at = 0.45;
  s.share = {0.2, 0.3, 0.4};
  s.bound = {0.7, 1, 1.4};
  s.share_slid = 0.97;
  s.seen = 0.99;
  return s;
}

TEST(StrainSlip, IsReadAsItWasWrittenAndNotWhereItIsDamaged) {
  const StrainSlip s = some_slip();
  const std::optional<StrainSlip> back = StrainSlip::read(s.bytes());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->bytes(), s.bytes());
  EXPECT_EQ(back->share_slid, s.share_slid);
  EXPECT_EQ(back->seen, s.seen);
  std::string bytes = s.bytes();
  bytes[40] ^= 1;
  EXPECT_FALSE(StrainSlip::read(bytes));
  EXPECT_FALSE(StrainSlip::read(bytes.substr(1)));
}

TEST(StrainSlip, ItsTablesAreWhatTheyWereBetweenAndHeldBeyond) {
  const StrainSlip s = some_slip();
  EXPECT_DOUBLE_EQ(s.normal(0, 0, 0), 1);
  EXPECT_NEAR(s.normal(0.225, 0.225, 0), 0.975, 1e-12);
  EXPECT_NEAR(s.normal(0.3, 0.3, 0.5), 0.955, 1e-12);
  EXPECT_NEAR(s.normal(2, 2, 1), 0.91, 1e-12);
  EXPECT_NEAR(s.normal(0.3, 0.45, 0), 0.97 * (1 - 0.02), 1e-12);  // two thirds of the way in
  EXPECT_NEAR(s.sticks(0.45), 1, 1e-12);
  EXPECT_GT(s.sticks(0.1), 1);
  EXPECT_EQ(StrainSlip::slid_at(0), 0);
  EXPECT_EQ(StrainSlip::slid_at(1), 1);
}

// Of a friction at which hardly anything slips a retreat has no loss to be scaled by.
TEST(StrainSlip, ARimThatDoesNotSlipLosesNothingWithoutBound) {
  StrainSlip s = some_slip();
  s.straight = {1, 1, 1};
  EXPECT_NEAR(s.normal(0.3, 0.45, 0), 1, 1e-12);
  s.straight = {0.9, 0.95, 1.0001};
  const double out = s.normal(0.1, 0.15, 0);
  EXPECT_GT(out, 0.7);
  EXPECT_LE(out, 1);
}

// In and aside, aside alone as far as it slips, back, and out.
std::vector<Vec3> way() {
  std::vector<Vec3> all;
  for (int i = 1; i <= 5; ++i) all.emplace_back(0.03 * i, 0.02 * i, -0.12 * i);
  for (int i = 1; i <= 5; ++i) all.emplace_back(0.15 + 0.08 * i, 0.1, -0.6);
  for (int i = 1; i <= 5; ++i) all.emplace_back(0.55 - 0.05 * i, 0.1, -0.6);
  for (int i = 4; i >= 2; --i) all.emplace_back(0.3, 0.1, -0.12 * i);
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
  FullPress held(mesh, test::strained_model(), at, test::kStrainedRadius,
                 strain_elements(base, 0.5));
  ForceLoop loop(body);
  // The contact's stiffness has errors of its own, which are not those of slip.
  const SurfaceSide side = body.distance().at(at);
  const Vec3 n = side.normal;
  const double ratio =
      n.dot(body.facts().at(side.face, side.point, n).contact.K * n) / n.dot(*held.stiffness() * n);
  loop.begin(at);
  double worst = 0, worst_held = 0, peak = 0;
  int covered = 0, rows = 0;
  double t = 0;
  for (const Vec3& v : way()) {
    const Vec3 u = test::kStrainedRadius * v;
    const Vec3 truth = ratio * elements.step(u, 0), f = loop.press(t += 0.1, u);
    const Vec3 stuck = ratio * held.step(u, 0);
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
