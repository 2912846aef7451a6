// Moduli where the tetrahedra of a body are numbered: identities, finite differences, and a ball
// that is one already.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

#include "contact/featured_body.h"
#include "contact/marker_solution.h"
#include "contact/tool_torque_solution.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kLabelRadius = 0.004, kLabelNu = 0.42;
const Vec3 kBall(0.03, 0.025, 0.021);
constexpr double kBallRadius = 0.006;

// Number 1: a ball of tetrahedra under the place that is pressed; 2: a corner that is at the
// surface.
TetMesh labelled_block(int one = 1, int two = 2, int ground = 0) {
  TetMesh body = test::block_mesh({0.06, 0.05, 0.03}, 30, 25, 15, 1);
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 4; ++k) centre += body.nodes[body.tets[t][k]] / 4;
    body.region[t] = (centre - kBall).norm() < kBallRadius      ? one
                     : centre.x() > 0.042 && centre.z() > 0.018 ? two
                                                                : ground;
  }
  return body;
}

const ContactBase& block_base() {
  static const ContactBase base =
      make_contact_base(test::block_mesh({0.06, 0.05, 0.03}, 6, 5, 3, 1));
  return base;
}
const ContactMesh& block_contact() {
  static const ContactMesh mesh =
      make_contact_mesh(block_base(), {0.033, 0.024, 0.03}, kLabelRadius, kLabelRadius / 4, 0.5);
  return mesh;
}

Material labelled(const TetMesh& body, const std::vector<double>& modulus, double nu = kLabelNu) {
  Material material{nu, modulus, nullptr, {}, nullptr};
  material.labels = BodyRegions::of(body);
  return material;
}

FeaturedBody::Solution solve(const Material& material) {
  FeaturedBody body(block_contact(), free_surface(block_base()));
  return body.solve(material);
}

TEST(LabelledBody, EqualModuliAreTheHomogeneousBody) {
  const Eigen::Matrix3d plain = solve({kLabelNu, {1e4}, nullptr, {}, nullptr}).K;
  const FeaturedBody::Solution s = solve(labelled(labelled_block(), {1e4, 1e4, 1e4}));
  EXPECT_LT((s.K - plain).norm(), 1e-10 * plain.norm());
}

TEST(LabelledBody, NumbersAreNames) {
  const Eigen::Matrix3d K = solve(labelled(labelled_block(), {1e4, 3e4, 5e3})).K;
  const Eigen::Matrix3d other = solve(labelled(labelled_block(0, 1, 2), {3e4, 5e3, 1e4})).K;
  EXPECT_LT((K - other).norm(), 1e-10 * K.norm());
}

TEST(LabelledBody, DerivativesAreThoseOfDifferences) {
  const TetMesh body = labelled_block();
  const std::vector<double> modulus{1e4, 3e4, 5e3};
  const FeaturedBody::Solution s = solve(labelled(body, modulus));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t g = 0; g < 3; ++g) {
    sum += modulus[g] * s.by_modulus[g];
    auto up = modulus, down = modulus;
    const double step = 1e-4 * modulus[g];
    up[g] += step;
    down[g] -= step;
    const Eigen::Matrix3d difference =
        (solve(labelled(body, up)).K - solve(labelled(body, down)).K) / (2 * step);
    EXPECT_LT((s.by_modulus[g] - difference).norm(), 1e-6 * difference.norm()) << g;
  }
  EXPECT_LT((sum - s.K).norm(), 1e-10 * s.K.norm());
  const Eigen::Matrix3d by_nu = (solve(labelled(body, modulus, kLabelNu + 1e-5)).K -
                                 solve(labelled(body, modulus, kLabelNu - 1e-5)).K) /
                                2e-5;
  EXPECT_LT((s.by_nu - by_nu).norm(), 2e-5 * s.K.norm());
}

// The staircase of the labels is a ball of another volume: one of that is compared. Elements at the
// boundary have the geometric mean here and the mixture in parallel there, which is stiffer; what
// that makes of the ball's work falls with the edges.
TEST(LabelledBody, ABallOfLabelsTendsToAnInclusion) {
  TetMesh body = labelled_block(1, 0);
  double volume = 0;
  for (std::size_t t = 0; t < body.tets.size(); ++t)
    if (body.region[t] == 1) volume += tet_volume(body, t);
  const double radius = std::cbrt(3 * volume / (4 * 3.14159265358979));
  const ContactMesh fine =
      make_contact_mesh(block_base(), block_contact().point, kLabelRadius, kLabelRadius / 4, 0.22);
  for (const double ratio : {0.3, 5.0}) {
    const BodyFeature ball{Feature::kInclusion, {kBall.x(), kBall.y(), kBall.z(), radius, ratio}};
    double coarse = 0;
    for (const ContactMesh* mesh : {&block_contact(), &fine}) {
      FeaturedBody solved(*mesh, free_surface(block_base()));
      const double plain = solved.solve({kLabelNu, {1e4}, nullptr, {}, nullptr}).K(2, 2);
      const double of_labels = solved.solve(labelled(body, {1e4, ratio * 1e4})).K(2, 2);
      const double of_ball = solved.solve({kLabelNu, {1e4}, nullptr, {ball}, nullptr}).K(2, 2);
      EXPECT_LT(of_labels, of_ball) << ratio;
      EXPECT_GT(std::abs(of_ball / plain - 1), 0.03) << ratio;
      const double apart = std::abs((of_labels - plain) / (of_ball - plain) - 1);
      std::printf("ratio %.1f: %.3f of what the ball does apart\n", ratio, apart);
      if (mesh == &fine) {
        EXPECT_LT(apart, 0.75 * coarse) << ratio;
      }
      coarse = apart;
      EXPECT_LT(apart, 0.2) << ratio;
    }
  }
}

// The derivative by a growth beside those by the moduli, with another feature.
TEST(LabelledBody, GrowthHasItsDerivative) {
  Material material = labelled(labelled_block(), {1e4, 3e4, 5e3});
  material.features = {{Feature::kGrowth, {1, 0.0007}},
                       {Feature::kLayer, {0.002, 1.5}},
                       {Feature::kGrowth, {2, -0.0004}}};
  const FeaturedBody::Solution s = solve(material);
  for (const std::size_t f : {0, 2}) {
    auto up = material, down = material;
    up.features[f].value[1] += 2e-6;
    down.features[f].value[1] -= 2e-6;
    const Eigen::Matrix3d difference = (solve(up).K - solve(down).K) / 4e-6;
    EXPECT_LT((s.by_feature[f][1] - difference).norm(), 0.02 * difference.norm()) << f;
    EXPECT_EQ(s.by_feature[f][0].norm(), 0);
    EXPECT_GT(difference.norm() * 0.001, 1e-3 * s.K.norm()) << f;
  }
  const Eigen::Matrix3d by_modulus = [&] {
    auto up = material, down = material;
    up.modulus[1] += 3;
    down.modulus[1] -= 3;
    return Eigen::Matrix3d((solve(up).K - solve(down).K) / 6);
  }();
  EXPECT_LT((s.by_modulus[1] - by_modulus).norm(), 1e-5 * by_modulus.norm());
}

// What torques and marked points come from is the same body.
TEST(LabelledBody, TorquesAndPointsHaveTheRegions) {
  const Material material = labelled(labelled_block(), {1e4, 3e4, 5e3});
  const Eigen::Matrix3d K = solve(material).K;
  const TorqueSolution torque = solve_torque(block_contact(), material);
  EXPECT_LT((torque.K - K).norm(), 1e-9 * K.norm());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t g = 0; g < 3; ++g) sum += material.modulus[g] * torque.dT_dmodulus[g];
  EXPECT_LT((sum - torque.T).norm(), 1e-9 * torque.K.norm() * kLabelRadius);
  const std::vector<Vec3> points{{0.045, 0.024, 0.03}};
  const Eigen::Matrix3d G = solve_markers(block_contact(), material, points).G[0];
  auto up = material, down = material;
  up.modulus[2] *= 1.001;
  down.modulus[2] /= 1.001;
  const Eigen::Matrix3d difference = (solve_markers(block_contact(), up, points).G[0] -
                                      solve_markers(block_contact(), down, points).G[0]) /
                                     (up.modulus[2] - down.modulus[2]);
  const Eigen::Matrix3d exact = solve_markers(block_contact(), material, points).dG_dmodulus[2][0];
  EXPECT_LT((exact - difference).norm(), 1e-4 * exact.norm());
  EXPECT_GT(G.norm(), 0.01);
}

}  // namespace
}  // namespace hapsim
