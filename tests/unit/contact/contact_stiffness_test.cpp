// The contact stiffness against closed forms, finite differences and finer meshes.
#include "contact/contact_stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "contact/contact_library.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004;

ContactBase block_base(const Vec3& size) {
  return make_contact_base(test::block_mesh(size, 8, 8, 6, 1));
}

// A large block stands for the half-space: 100 mm wide, 60 mm deep under a 4 mm tool.
class HalfSpace : public ::testing::Test {
 protected:
  static StiffnessSolution solve(double nu, double rim_edge = kRimEdge, double radius = kRadius) {
    static const ContactBase base = block_base({0.1, 0.1, 0.06});
    ContactBodies bodies(base, {0.05, 0.05, 0.06}, radius, rim_edge);
    return bodies.solve({nu, {1.0}, nullptr}, plan_grid(base.surface));
  }
};

// Rigid flat circular punch bonded to a half-space, normal load: F = 4 mu a log(3 - 4 nu)/(1 - 2
// nu) (Mossakovskii, 1954; Johnson, Contact Mechanics, 3.8). A finite block is stiffer by a share
// that is proportional to radius / size and to its square, so three radii on one block extrapolate
// to the half-space.
TEST_F(HalfSpace, NormalStiffnessIsTheBondedPunch) {
  for (const double nu : {0.0, 0.3, 0.45, 0.49, 0.499}) {
    const double mu = 1 / (2 * (1 + nu));
    const auto ratio = [&](double radius) {
      const StiffnessSolution s = solve(nu, kRimEdge, radius);
      const double exact = 4 * mu * radius * std::log(3 - 4 * nu) / (1 - 2 * nu);
      return s.normal.dot(s.K * s.normal) / exact;
    };
    const double large = ratio(kRadius), small = ratio(kRadius / 2), least = ratio(kRadius / 4);
    const double none = (8 * least - 6 * small + large) / 3;
    std::printf("nu %.2f: K / half-space %.4f, half the radius %.4f, a quarter %.4f, none %.4f\n",
                nu, large, small, least, none);
    // Compressible material feels the rim more.
    EXPECT_NEAR(none, 1, nu < 0.2 ? 0.015 : 0.005);
  }
}

// The stated uncertainty covers what a mesh with half the elements' size changes.
TEST_F(HalfSpace, StatedUncertaintyCoversTheError) {
  for (const double nu : {0.0, 0.3, 0.45}) {
    const StiffnessSolution standard = solve(nu);
    const StiffnessSolution finer = solve(nu, kRimEdge / 2);
    const double a = standard.normal.dot(standard.K * standard.normal);
    const double b = finer.normal.dot(finer.K * finer.normal);
    const double stated = mesh_uncertainty(standard);
    std::printf("nu %.2f: differs from the finer mesh by %.2f %%, stated %.2f %%\n", nu,
                100 * (a / b - 1), 100 * stated);
    EXPECT_LT(std::abs(a / b - 1), stated);
    EXPECT_LT(stated, 0.02);
  }
}

// Wherever the tool stands on a body's triangle that is many times as wide as it: 0.5 to 0.7 %
// above the half-space at 150 radii of depth, less the 0.25 % that the rim is too soft.
TEST(ContactStiffness, ABodyOfHundredsOfRadiiIsAHalfSpace) {
  const double a = kRadius, wide = 300 * a, nu = 0.45;
  const ContactBase base =
      make_contact_base(test::block_mesh({wide, wide, wide / 2}, 12, 12, 8, 1));
  const double half_space = 4 * a * std::log(3 - 4 * nu) / (2 * (1 + nu) * (1 - 2 * nu));
  for (const double aside : {0.0, 3.7, 7.4, 11.0}) {
    ContactBodies bodies(base, {wide / 2 + aside * a, wide / 2, wide / 2}, a, kRimEdge);
    const StiffnessSolution s = bodies.solve({nu, {1.0}, nullptr}, plan_grid(base.surface));
    const double ratio = s.normal.dot(s.K * s.normal) / half_space;
    std::printf("%.1f radii aside: K / half-space %.4f, stated %.2f %%\n", aside, ratio,
                100 * mesh_uncertainty(s));
    EXPECT_NEAR(ratio, 1.003, 0.004);
    EXPECT_LT(mesh_uncertainty(s), 0.01);
  }
}

TEST_F(HalfSpace, IsSymmetricAndIsotropicInThePlane) {
  const StiffnessSolution s = solve(0.4);
  EXPECT_LT((s.K - s.K.transpose()).norm(), 1e-10 * s.K.norm());
  EXPECT_NEAR(s.K(0, 0) / s.K(1, 1), 1, 0.01);
  EXPECT_LT(std::abs(s.K(0, 2)), 0.01 * s.K(2, 2));
}

TEST_F(HalfSpace, PoissonDerivativeIsTheDifference) {
  const double nu = 0.35, step = 1e-4;
  const Eigen::Matrix3d difference = (solve(nu + step).K - solve(nu - step).K) / (2 * step);
  EXPECT_LT((solve(nu).dK_dnu - difference).norm(), 1e-5 * difference.norm());
}

// Over an edge of the body it runs steadily, from the coarsest mesh on, where the samples between
// which the live force is interpolated come from; and the mesh there is as fine as it must be.
TEST(ContactStiffness, RunsSteadilyOverAnEdge) {
  const ContactBase base = block_base({0.1, 0.1, 0.06});
  const auto K_at = [&](double from_edge, ContactLevel level, double rim_edge = kRimEdge) {
    ContactBodies bodies(base, {0.1 - from_edge * kRadius, 0.047, 0.06}, kRadius, rim_edge);
    return bodies.sample({0.45, {1.0}, nullptr}, level).K;
  };
  std::vector<Eigen::Matrix3d> K;
  for (int i = 0; i <= 25; ++i) K.push_back(K_at(0.1 * i, ContactLevel::kSample));
  double largest = 0;
  for (std::size_t i = 1; i + 1 < K.size(); ++i)
    largest = std::max(largest, (K[i] - 0.5 * (K[i - 1] + K[i + 1])).norm() / K[i].norm());
  std::printf("off its neighbours' middle by at most %.2f %%\n", 100 * largest);
  EXPECT_LT(largest, 0.01);
  for (const double from_edge : {0.0, 0.9, 1.1, 1.5}) {
    const Eigen::Matrix3d fine = K_at(from_edge, ContactLevel::kFine),
                          finer = K_at(from_edge, ContactLevel::kFine, kRimEdge / 1.6);
    EXPECT_LT((fine - finer).norm(), 0.008 * finer.norm()) << from_edge;
  }
}

TEST(ContactStiffness, RegionDerivativesAreTheDifferences) {
  const ContactBase base = block_base({0.08, 0.08, 0.04});
  ContactBodies bodies(base, {0.042, 0.04, 0.04}, kRadius, 0.25);
  const PlanGrid grid = plan_grid(base.surface);
  Material material{0.4, {1e4, 3e4}, [](const Vec3& p) { return p.x() > 0.04 ? 1 : 0; }};
  const StiffnessSolution s = bodies.solve(material, grid);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int g = 0; g < 2; ++g) {
    sum += material.modulus[g] * s.dK_dmodulus[g];
    Material up = material, down = material;
    up.modulus[g] *= 1.001;
    down.modulus[g] *= 0.999;
    const Eigen::Matrix3d difference =
        (bodies.solve(up, grid).K - bodies.solve(down, grid).K) / (0.002 * material.modulus[g]);
    EXPECT_LT((s.dK_dmodulus[g] - difference).norm(), 1e-4 * difference.norm());
  }
  EXPECT_LT((s.K - sum).norm(), 1e-9 * s.K.norm());  // homogeneous of degree one
  double share = 0;
  for (const float part : s.plan_share) share += part;
  EXPECT_NEAR(share, 1, 1e-4);
}

// The cheap solution of an inhomogeneous body against the full one.
TEST(ContactStiffness, CorrectedCoarseSolutionIsTheFullOne) {
  const ContactBase base = block_base({0.08, 0.08, 0.04});
  const PlanGrid grid = plan_grid(base.surface);
  for (const double edge : {0.036, 0.042, 0.05}) {
    ContactBodies bodies(base, {0.042, 0.04, 0.04}, kRadius);
    const Material material{
        0.4, {1e4, 3e4}, [edge](const Vec3& p) { return p.x() > edge ? 1 : 0; }};
    const StiffnessSolution full = bodies.solve(material, grid);
    const StiffnessSolution unit = bodies.solve({0.4, {1.0}, nullptr}, grid);
    const StiffnessSolution cheap = bodies.solve_corrected(
        material, {unit.K, unit.dK_dnu}, {unit.K + unit.coarse_change, unit.coarse_dK_dnu});
    const double error = (cheap.K - full.K).norm() / full.K.norm();
    std::printf("boundary at %.0f mm: corrected coarse solution differs by %.2g\n", 1e3 * edge,
                error);
    // Where the boundary crosses the patch the two meshes share it out differently.
    EXPECT_LT(error, 0.03);
    EXPECT_LT((cheap.dK_dnu - full.dK_dnu).norm(), 0.1 * full.dK_dnu.norm());
  }
}

TEST(ContactLibrary, InterpolatesInPoissonsRatioAndCaches) {
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
  const std::string cache = ::testing::TempDir() + "hapsim_contact_cache";
  ContactLibraryOptions options;
  options.cache = cache;

  const std::vector<Vec3> positions{{0.03, 0.035, 0.04}, {0.05, 0.04, 0.04}};
  const ContactLibrary library(body, kRadius, options);
  const auto prepared = library.prepare(positions, 0.0, 0.499);
  options.cache.clear();
  const ContactLibrary uncached(body, kRadius, options);
  double worst = 0;
  for (const double nu : {0.02, 0.2, 0.33, 0.45, 0.48, 0.495}) {
    const auto exact = uncached.prepare(positions, nu, nu);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      Eigen::Matrix3d K, dK, reference, reference_dK;
      prepared[p].stiffness.evaluate(nu, K, dK);
      exact[p].stiffness.evaluate(nu, reference, reference_dK);
      const double error = (K - reference).norm() / reference.norm();
      std::printf("nu %.3f: error of the interpolation %.2g\n", nu, error);
      worst = std::max(worst, error);
    }
  }
  std::printf("interpolation in nu: worst error %.2g\n", worst);
  EXPECT_LT(worst, 1e-3);
  // Again, now from the cache: the same numbers to the last bit.
  const auto expect_the_same = [&] {
    const auto again = library.prepare(positions, 0.0, 0.499);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      Eigen::Matrix3d a, b, ignored;
      prepared[p].stiffness.evaluate(0.4, a, ignored);
      again[p].stiffness.evaluate(0.4, b, ignored);
      EXPECT_EQ(a, b);
    }
  };
  expect_the_same();
  // A damaged entry is made again.
  for (const auto& entry : std::filesystem::directory_iterator(cache)) {
    std::fstream file(entry.path(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(40);
    file.put('!');
  }
  expect_the_same();
  std::filesystem::remove_all(cache);
}

}  // namespace
}  // namespace hapsim
