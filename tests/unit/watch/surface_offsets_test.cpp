// A mesh's faces taken as curved, and what the points seen add to that.
#include "watch/surface_offsets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "realtime/curved_face.h"
#include "support/block_mesh.h"
#include "support/objects.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.05;

// Half a ball; its upper half is asked for.
Surface ball(int rings) {
  return test::dome([](const Vec3&) { return kRadius; }, rings);
}

Vec3 upper(Random& random) {
  const double turn = 2 * std::numbers::pi * random.uniform(), lean = 0.9 * random.uniform();
  return kRadius *
         Vec3(std::sin(lean) * std::cos(turn), std::sin(lean) * std::sin(turn), std::cos(lean));
}

// Largest error of where the ball's surface lies.
double worst(const SurfaceOffsets& offsets, const SignedDistance& distance, bool flat) {
  Random random(3);
  double error = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = upper(random);
    Vec3 normal;
    error = std::max(error, std::abs(distance.at(p).distance - (flat ? 0 : offsets.at(p, normal))));
  }
  return error;
}

TEST(SurfaceOffsets, CurvedFacesLieNearerToABall) {
  const SignedDistance coarse(ball(6)), fine(ball(12));
  const SurfaceOffsets none_coarse(coarse), none_fine(fine);
  const double flat = worst(none_coarse, coarse, true), curved = worst(none_coarse, coarse, false);
  EXPECT_LT(curved, 0.25 * flat);
  // Flat faces are of second order; these of a higher one.
  EXPECT_GT(curved / worst(none_fine, fine, false), 5);
}

TEST(SurfaceOffsets, ABlocksEdgesStayStraight) {
  const SignedDistance block(boundary_surface(test::block_mesh({0.08, 0.06, 0.04}, 4, 3, 2, 1)));
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const SurfaceSide side =
        block.at(Vec3(0.08 * random.uniform(), 0.06 * random.uniform(), 0.05 * random.uniform()));
    Vec3 normal;
    EXPECT_NEAR(curved_height(block, side.face, side.point, normal), 0, 1e-9);
  }
}

TEST(SurfaceOffsets, PointsSeenAreKept) {
  const SignedDistance mesh(ball(6));
  SurfaceOffsets offsets(mesh);
  Random random(7);
  std::vector<Vec3> points;  // on a ball that is 0.3 mm larger
  for (int i = 0; i < 20; ++i) points.push_back(1.006 * upper(random));
  for (const Vec3& p : points) offsets.add(p);
  EXPECT_LT(offsets.uncertainty(), 5e-5);
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = 1.006 * upper(random);
    Vec3 normal;
    EXPECT_NEAR(offsets.at(p, normal), mesh.at(p).distance, 1e-4);
    EXPECT_GT(normal.dot(p.normalized()), 0.99);
  }
}

}  // namespace
}  // namespace hapsim
