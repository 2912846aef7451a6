// Points of the surface that move with a bonded flat tool: a closed form, derivatives, frames.
#include "contact/marker_solution.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "contact/surface_place.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kMarkerRadius = 0.004;
const Vec3 kNearEdge(0.055, 0.03, 0.03);
const std::vector<Vec3> kPoints{{0.048, 0.03, 0.03}, {0.055, 0.037, 0.03}, {0.06, 0.031, 0.024}};

TetMesh block() {
  return test::block_mesh({0.06, 0.06, 0.03}, 8, 8, 6, 1);
}

ContactMesh contact_at(const ContactBase& base, const Vec3& point) {
  return make_contact_mesh(base, point, kMarkerRadius, kMarkerRadius / 3, 0.8);
}

// A bonded disc on an incompressible half-space is a frictionless one: outside it the surface sinks
// by 2/pi asin(a/r) of the disc's depth (Sneddon, 1965).
TEST(MarkerSolution, IsSneddonsSurface) {
  const double size = 200 * kMarkerRadius, depth = size / 2;
  const ContactBase base = make_contact_base(test::block_mesh({size, size, depth}, 8, 8, 6, 1));
  const Vec3 middle(size / 2, size / 2, depth);
  std::vector<Vec3> points;
  for (const double r : {1.1, 1.25, 1.5, 2.0, 3.0, 5.0})
    for (const double angle : {0.0, 1.0, 2.5, 4.0})
      points.push_back(middle + r * kMarkerRadius * Vec3(std::cos(angle), std::sin(angle), 0));
  const MarkerSolution s =
      solve_markers(make_contact_mesh(base, middle, kMarkerRadius, kMarkerRadius / 6, 0.4),
                    {0.4999, {1.0}, nullptr, {}}, points);
  double worst = 0;
  for (std::size_t m = 0; m < points.size(); ++m) {
    const double exact =
        2 / std::acos(-1.0) * std::asin(kMarkerRadius / (points[m] - middle).norm());
    worst = std::max(worst, std::abs(s.G[m](2, 2) - exact));
  }
  std::printf("surface beside a disc: off by at most %.4f of its depth\n", worst);
  EXPECT_LT(worst, 0.015);
}

TEST(MarkerSolution, DerivativesAreDifferences) {
  const ContactBase base = make_contact_base(block());
  const ContactMesh contact = contact_at(base, kNearEdge);
  const auto group = [](const Vec3& p) { return p.x() > 0.052 ? 1 : 0; };
  const auto solve = [&](double nu, double beside) {
    return solve_markers(contact, {nu, {1000.0, beside}, group, {}}, kPoints);
  };
  const double step = 1e-4, dE = 1;
  const MarkerSolution at = solve(0.35, 3000), up = solve(0.35 + step, 3000),
                       down = solve(0.35 - step, 3000), more = solve(0.35, 3000 + dE),
                       less = solve(0.35, 3000 - dE);
  for (std::size_t m = 0; m < kPoints.size(); ++m) {
    const Eigen::Matrix3d by_nu = (up.G[m] - down.G[m]) / (2 * step);
    EXPECT_LT((at.dG_dnu[m] - by_nu).norm(), 1e-5 * by_nu.norm());
    const Eigen::Matrix3d by_E = (more.G[m] - less.G[m]) / (2 * dE);
    EXPECT_LT((at.dG_dmodulus[1][m] - by_E).norm(), 1e-5 * by_E.norm());
    // A common factor of the moduli does nothing.
    EXPECT_LT((1000 * at.dG_dmodulus[0][m] + 3000 * at.dG_dmodulus[1][m]).norm(),
              1e-9 * 3000 * by_E.norm());
  }
}

TEST(MarkerSolution, TurnsWithTheBody) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  TetMesh turned = block();
  for (Vec3& p : turned.nodes) p = (R * p).eval();
  std::vector<Vec3> points;
  for (const Vec3& p : kPoints) points.push_back(R * p);
  const Material material{0.4, {1.0}, nullptr, {}};
  const MarkerSolution s =
      solve_markers(contact_at(make_contact_base(block()), kNearEdge), material, kPoints);
  const MarkerSolution s_turned =
      solve_markers(contact_at(make_contact_base(turned), R * kNearEdge), material, points);
  for (std::size_t m = 0; m < points.size(); ++m)
    EXPECT_LT((s_turned.G[m] - R * s.G[m] * R.transpose()).cwiseAbs().maxCoeff(), 0.02);
}

// Under the tool a point moves with it, on the support not at all, and a linear field is its own
// interpolation, also on faces whose middles are at quarter points.
TEST(MarkerSolution, InterpolatesInTheSurfacesElements) {
  const ContactBase base = make_contact_base(block());
  const ContactMesh contact = contact_at(base, kNearEdge);
  const MarkerSolution s = solve_markers(contact, {0.4, {1.0}, nullptr, {}},
                                         {kNearEdge + Vec3(0.001, 0.001, 0), {0.03, 0.03, 0}});
  EXPECT_LT((s.G[0] - Eigen::Matrix3d::Identity()).norm(), 1e-10);
  EXPECT_LT(s.G[1].norm(), 1e-12);
  std::vector<Vec3> points;
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.157 * k, r = kMarkerRadius * (0.9 + 0.02 * k);
    const Vec3 p = kNearEdge + r * Vec3(std::cos(angle), std::sin(angle), 0);
    if (p.x() < 0.06) points.push_back(p);
  }
  const std::vector<SurfacePlace> places = surface_places(contact.mesh, points);
  for (std::size_t m = 0; m < points.size(); ++m) {
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < 6; ++k)
      x += places[m].weight[k] * contact.mesh.nodes[static_cast<std::size_t>(places[m].node[k])];
    EXPECT_LT((x - points[m]).norm(), 1e-9);
  }
}

TEST(MarkerSolution, IsAnEntryOfTheCache) {
  const ContactBase base = make_contact_base(block());
  const MarkerSolution s = solve_markers(
      contact_at(base, kNearEdge),
      {0.4, {1.0, 2.0}, [](const Vec3& p) { return p.x() > 0.05 ? 1 : 0; }, {}}, kPoints);
  const auto back = unpacked_markers(packed(s));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->G, s.G);
  EXPECT_EQ(back->dG_dnu, s.dG_dnu);
  EXPECT_EQ(back->coarse_G, s.coarse_G);
  EXPECT_EQ(back->dG_dmodulus, s.dG_dmodulus);
  EXPECT_FALSE(unpacked_markers(StiffnessSolution{}));
}

}  // namespace
}  // namespace hapsim
