// Signed distance against closed forms, a moving tool, and the three nearest nodes beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "mesh/signed_distance.h"
#include "mesh/three_nodes.h"
#include "mesh/tool_contact.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

// Of the box [0, size], exact.
double box_distance(const Vec3& p, const Vec3& size) {
  const Vec3 q = (p - size / 2).cwiseAbs() - size / 2;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

Vec3 random_in(Random& random, const Vec3& low, const Vec3& high) {
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = low[k] + random.uniform() * (high[k] - low[k]);
  return p;
}

TEST(SignedDistance, IsThatOfABoxEverywhere) {
  const Vec3 size(1, 2, 3);
  const SignedDistance body(test::box(size, 3));
  Random random(3);
  int hint = -1;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random_in(random, {-1, -1, -1}, size + Vec3(1, 1, 1));
    const SurfaceSide side = body.at(p, hint);
    ASSERT_NEAR(side.distance, box_distance(p, size), 1e-12);
    ASSERT_EQ(side.distance, body.at(p).distance);
    ASSERT_NEAR(side.normal.norm(), 1, 1e-12);
    hint = side.face;
  }
}

TEST(SignedDistance, HasTheRightSignAtEdgesAndCorners) {
  const Vec3 size(1, 1, 1);
  const SignedDistance body(test::box(size));
  Random random(4);
  for (const double scale : {1e-2, 1e-6, 1e-10})
    for (int i = 0; i < 3000; ++i) {
      Vec3 at(random.integer(2), random.integer(2), random.integer(2));
      if (random.coin()) at[static_cast<int>(random.integer(3))] = random.uniform();
      const Vec3 p = at + scale * random_in(random, {-1, -1, -1}, {1, 1, 1});
      const double exact = box_distance(p, size);
      ASSERT_NEAR(body.at(p).distance, exact, 1e-15 + 1e-9 * scale);
      if (std::abs(exact) > 1e-14) {
        ASSERT_EQ(body.at(p).distance > 0, exact > 0) << p.transpose();
      }
    }
}

// A needle-sharp roof: the nearest point of most places above is its ridge, behind which both
// faces see them; a face's own normal gives the wrong side there.
TEST(SignedDistance, SurvivesASharpRidge) {
  Surface roof;
  roof.vertices = {{-0.01, 0, 0}, {0.01, 0, 0}, {0.01, 1, 0}, {-0.01, 1, 0}, {0, 0, 1}, {0, 1, 1}};
  roof.faces = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {3, 5, 2},
                {1, 2, 5}, {1, 5, 4}, {0, 4, 5}, {0, 5, 3}};
  const SignedDistance body(roof);
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random_in(random, {-1, 0.1, 1.001}, {1, 0.9, 2});
    EXPECT_GT(body.at(p).distance, 0) << p.transpose();
  }
  EXPECT_LT(body.at({0, 0.5, 0.9}).distance, 0);
}

TEST(SignedDistance, RefusesAnOpenSurface) {
  Surface open = test::box({1, 1, 1});
  open.faces.pop_back();
  const auto [code, what] = test::error_of([&] { SignedDistance body(open, "s.ply"); });
  EXPECT_EQ(code, 3);
  EXPECT_NE(what.find("1 hole: of 3 edges about"), std::string::npos) << what;
}

TEST(ToolContact, TouchesHoldsLeavesAndReturns) {
  const SignedDistance body(test::box({0.1, 0.1, 0.05}, 10));
  ToolContact tool(body);
  const Vec3 above(0.033, 0.047, 0);
  const auto at = [&](double z, double x = 0) { return tool.update(above + Vec3(x, 0, z)); };
  EXPECT_EQ(at(0.06).phase, ContactPhase::kAway);
  EXPECT_NEAR(tool.state().surface.distance, 0.01, 1e-12);
  EXPECT_EQ(at(0.049).phase, ContactPhase::kBegan);
  EXPECT_EQ(tool.state().episode, 1);
  EXPECT_NEAR((tool.state().anchor - Vec3(0.033, 0.047, 0.05)).norm(), 0, 1e-12);
  EXPECT_EQ(at(0.047, 0.004).phase, ContactPhase::kHeld);  // no sliding: the anchor stays
  EXPECT_NEAR((tool.state().anchor - Vec3(0.033, 0.047, 0.05)).norm(), 0, 1e-12);
  EXPECT_NEAR((tool.state().displacement - Vec3(0.004, 0, -0.003)).norm(), 0, 1e-12);
  EXPECT_EQ(at(0.052).phase, ContactPhase::kEnded);
  EXPECT_EQ(at(0.053).phase, ContactPhase::kAway);
  EXPECT_EQ(tool.state().displacement.norm(), 0);
  EXPECT_EQ(at(0.0499, 0.02).phase, ContactPhase::kBegan);
  EXPECT_EQ(tool.state().episode, 2);
  EXPECT_NEAR(tool.state().anchor.x(), 0.053, 1e-12);
  EXPECT_EQ(tool.update(Vec3::Constant(std::nan(""))).phase, ContactPhase::kBegan);
}

TEST(ToolContact, SlidesOverAnEdgeAndDoesNotJumpThrough) {
  const SignedDistance body(test::box({0.1, 0.1, 0.02}, 20));
  ToolContactOptions options;
  options.slides = true;
  ToolContact tool(body, options);
  Vec3 last = Vec3::Zero();
  for (int i = 0; i <= 400; ++i) {  // along the top, 1 mm deep, then down the side
    const double s = 0.0005 * i;
    const Vec3 p = s < 0.079 ? Vec3(0.02 + s, 0.05, 0.019) : Vec3(0.099, 0.05, 0.019 - (s - 0.079));
    if (p.z() < 0.002) break;
    const ToolState& state = tool.update(p);
    ASSERT_TRUE(state.touching());
    ASSERT_EQ(state.episode, 1);
    ASSERT_NEAR(state.surface.distance, -0.001, 1e-9);
    if (i > 0) {
      ASSERT_LT((state.anchor - last).norm(), 0.0021);  // the corner is cut by its depth
    }
    last = state.anchor;
  }
  EXPECT_NEAR(last.x(), 0.1, 1e-12);  // ended on the side

  ToolContact deep(body);  // pressed beyond the middle of a thin body: still the top
  deep.update({0.05, 0.05, 0.0199});
  EXPECT_NEAR(deep.update({0.05, 0.05, 0.005}).surface.distance, -0.015, 1e-9);
  EXPECT_NEAR(body.at({0.05, 0.05, 0.005}).distance, -0.005, 1e-9);
}

TEST(ToolContact, OfASphereTouchesByItsRadius) {
  const SignedDistance body(test::box({0.1, 0.1, 0.05}, 10));
  ToolContactOptions options;
  options.radius = 0.004;
  options.release = 0.0005;
  ToolContact tool(body, options);
  EXPECT_FALSE(tool.update({0.05, 0.05, 0.0545}).touching());
  EXPECT_TRUE(tool.update({0.05, 0.05, 0.053}).touching());
  EXPECT_NEAR((tool.state().displacement - Vec3(0, 0, -0.001)).norm(), 0, 1e-12);
  EXPECT_TRUE(tool.update({0.05, 0.05, 0.0543}).touching());  // noise about the surface
  EXPECT_FALSE(tool.update({0.05, 0.05, 0.0546}).touching());
}

TEST(ThreeNodes, FindsTheNearestThreeAndTheSide) {
  const Surface surface = test::dome(0.05, 16);
  const ThreeNodes nodes(surface);
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_in(random, {-0.06, -0.06, 0}, {0.06, 0.06, 0.06});
    const NodePlane plane = nodes.at(p);
    std::vector<double> all;
    for (const Vec3& v : surface.vertices) all.push_back((v - p).norm());
    std::sort(all.begin(), all.end());
    EXPECT_DOUBLE_EQ((surface.vertices[plane.node[0]] - p).norm(), all[0]);
    EXPECT_DOUBLE_EQ((surface.vertices[plane.node[1]] - p).norm(), all[1]);
  }
  // The side comes from the surface, or from the velocity as in (2.7).
  const Vec3 above(0.001, 0.002, 0.06), down(0, 0, -1);
  EXPECT_GT(nodes.at(above).distance, 0);
  EXPECT_GT(nodes.at(above, down).distance, 0);
  EXPECT_LT(nodes.at(above, -down).distance, 0);  // leaving, (2.7) takes the wrong normal
  EXPECT_TRUE(nodes.at(Vec3(0.001, 0.002, 0.048), down).contact);
  EXPECT_EQ(ThreeNodes(Surface{}).at(above).node[0], -1);
}

TEST(ThreeNodes, ErrsWhereTheSignedDistanceDoesNot) {
  const double radius = 0.05;
  const Surface surface = test::dome(radius, 16);
  const SignedDistance body(surface);
  const ThreeNodes nodes(surface);
  Random random(7);
  double tree = 0, plane = 0;
  int wrong_tree = 0, wrong_plane = 0, count = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 d = random_in(random, {-1, -1, 0.1}, {1, 1, 1}).normalized();
    const double exact = 0.004 * (random.uniform() - 0.5);
    const Vec3 p = (radius + exact) * d;
    if (p.z() < 0.01) continue;  // away from the rim, where the half-ball has an edge
    ++count;
    tree += std::pow(body.at(p).distance - exact, 2);
    plane += std::pow(nodes.at(p).distance - exact, 2);
    wrong_tree += std::abs(exact) > 2e-4 && (body.at(p).distance > 0) != (exact > 0);
    wrong_plane += std::abs(exact) > 2e-4 && (nodes.at(p).distance > 0) != (exact > 0);
  }
  tree = std::sqrt(tree / count);
  plane = std::sqrt(plane / count);
  printf("rms error of the distance: triangles %.2g m, three nodes %.2g m\n", tree, plane);
  EXPECT_EQ(wrong_tree, 0);
  EXPECT_LT(tree, 1e-4);
  EXPECT_LE(tree, plane);
  // Beside a box, the plane through three nodes has no end: it claims contact beyond the edge.
  const Surface box = test::box({0.1, 0.1, 0.05}, 5);
  const Vec3 beside(0.104, 0.049, 0.0495);
  EXPECT_GT(SignedDistance(box).at(beside).distance, 0.0039);
}

}  // namespace
}  // namespace hapsim
