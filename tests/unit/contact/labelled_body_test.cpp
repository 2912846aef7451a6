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
// boundary are laminates of both; what is left is how the staircase lies in them.
TEST(LabelledBody, ABallOfLabelsIsAnInclusion) {
  TetMesh body = labelled_block(1, 0);
  double volume = 0;
  for (std::size_t t = 0; t < body.tets.size(); ++t)
    if (body.region[t] == 1) volume += tet_volume(body, t);
  const double radius = std::cbrt(3 * volume / (4 * 3.14159265358979));
  FeaturedBody solved(block_contact(), free_surface(block_base()));
  const double plain = solved.solve({kLabelNu, {1e4}, nullptr, {}, nullptr}).K(2, 2);
  for (const double ratio : {0.3, 5.0}) {
    const BodyFeature ball{Feature::kInclusion, {kBall.x(), kBall.y(), kBall.z(), radius, ratio}};
    const double of_labels = solved.solve(labelled(body, {1e4, ratio * 1e4})).K(2, 2);
    const double of_ball = solved.solve({kLabelNu, {1e4}, nullptr, {ball}, nullptr}).K(2, 2);
    EXPECT_GT(std::abs(of_ball / plain - 1), 0.03) << ratio;
    const double apart = std::abs((of_labels - plain) / (of_ball - plain) - 1);
    std::printf("ratio %.1f: %.3f of what the ball does apart\n", ratio, apart);
    EXPECT_LT(apart, 0.1) << ratio;
  }
}

// A sheet much thinner than the elements that it passes through, against elements that end at its
// faces. (Softer by far the stiffest of the tetrahedra beside each other carry too much.)
TEST(LabelledBody, AThinSheetIsFeltAsSuch) {
  const TetMesh body = test::block_mesh({0.02, 0.02, 0.02}, 4, 4, 40, 1);
  TetMesh labels = body;
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    double height = 0;
    for (int k = 0; k < 4; ++k) height += body.nodes[body.tets[t][k]].z() / 4;
    labels.region[t] = std::abs(height - 0.01225) < 0.00025;  // one row of 0.5 mm
  }
  const auto column = [](int rows) {
    ContactMesh contact;
    contact.mesh = test::block_mesh({0.02, 0.02, 0.02}, 4, 4, rows, 2);
    for (std::size_t n = 0; n < contact.mesh.nodes.size(); ++n)
      if (contact.mesh.nodes[n].z() > 0.02 - 1e-9)
        contact.patch_nodes.push_back(static_cast<int>(n));
    contact.point = {0.01, 0.01, 0.02};
    contact.normal = Vec3::UnitZ();
    return contact;
  };
  const ContactMesh coarse = column(6), conforming = column(40);
  const auto surface = std::make_shared<const SurfaceTree>(boundary_surface(body));
  FeaturedBody mixed(coarse, surface), exact(conforming, surface);
  for (const double ratio : {0.3, 5.0}) {
    const Eigen::Matrix3d K = mixed.solve(labelled(labels, {1e4, ratio * 1e4})).K;
    const FeaturedBody::Solution truth = exact.solve(labelled(labels, {1e4, ratio * 1e4}));
    std::printf("ratio %g: along the press %+.3f, across %+.3f\n", ratio,
                K(2, 2) / truth.K(2, 2) - 1, K(0, 0) / truth.K(0, 0) - 1);
    EXPECT_NEAR(K(2, 2), truth.K(2, 2), 0.06 * truth.K(2, 2)) << ratio;
    EXPECT_NEAR(K(0, 0), truth.K(0, 0), 0.06 * truth.K(0, 0)) << ratio;
    EXPECT_LT(truth.mixed.norm(), 1e-6 * truth.K.norm()) << ratio;  // nothing is cut
  }
}

// Meshes that end at a region's boundary mix nothing and give nearly what laminates across it do;
// where it reaches the surface, or grows, elements are cut.
TEST(LabelledBody, MeshesFollowWhatIsEnclosed) {
  const Vec3 at(0.033, 0.024, 0.03);
  const auto solution = [&](const TetMesh& body, double ratio, bool follow, bool grows = false) {
    Material material = labelled(body, {1e4, ratio * 1e4, 1e4});
    if (grows) material.features = {{Feature::kGrowth, {1, 1e-5}}};
    const auto inner = std::make_shared<const std::vector<Surface>>(material.labels->enclosed());
    ContactBodies bodies(block_base(), at, kLabelRadius, kRimEdge, nullptr,
                         follow ? inner : nullptr);
    return bodies.solve_featured(material);
  };
  const TetMesh ball = labelled_block(1, 0);
  for (const double ratio : {0.3, 5.0}) {
    const StiffnessSolution followed = solution(ball, ratio, true),
                            cut = solution(ball, ratio, false);
    EXPECT_EQ(followed.mixed.norm(), 0) << ratio;
    EXPECT_EQ(mixture_uncertainty(followed), 0) << ratio;
    const double apart = cut.K(2, 2) / followed.K(2, 2) - 1, told = mixture_uncertainty(cut);
    std::printf("ratio %g: cut %+.3f of followed, told %.3f\n", ratio, apart, told);
    EXPECT_LT(std::abs(apart), told) << ratio;
    EXPECT_LT(told, 0.1) << ratio;
    EXPECT_GT(solution(ball, ratio, true, true).mixed.norm(), 0) << ratio;
  }
  EXPECT_GT(solution(labelled_block(), 5, true).mixed.norm(), 0);
}

// By hand: of diag(K) = (1, 2, 4) and a doubt of diag (0.5, 0.1, 0.1) the normal knows 2.5 %.
TEST(MixtureUncertainty, IsOfTheDirectionThatKnowsLeast) {
  StiffnessSolution s;
  s.normal = Vec3::UnitZ();
  s.K = Eigen::Vector3d(1, 2, 4).asDiagonal();
  s.mixed = Eigen::Vector3d(0.5, 0.1, 0.1).asDiagonal();
  EXPECT_NEAR(mixture_uncertainty(s), 0.5, 1e-12);
  s.mixed.setZero();
  EXPECT_EQ(mixture_uncertainty(s), 0);
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

// What torques and marked points come from is the same body but for the elements at boundaries,
// which are of one modulus there.
TEST(LabelledBody, TorquesAndPointsHaveTheRegions) {
  const Material material = labelled(labelled_block(), {1e4, 3e4, 5e3});
  const Eigen::Matrix3d K = solve(material).K;
  const TorqueSolution torque = solve_torque(block_contact(), material);
  EXPECT_LT((torque.K - K).norm(), 0.02 * K.norm());
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
