// Laminates against the closed forms of plane stress and of Backus; derivatives by differences.
#include "solid/laminate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "material/unit_law.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kLaminateNu = 0.42;

VoigtMatrix full(const UnitLaw& law) {
  VoigtMatrix D = law.D;
  D.topLeftCorner<3, 3>().array() += law.kappa;
  return D;
}

TEST(Laminate, AlongTheLayersItIsPlaneStress) {
  for (const double nu : {0.0, 0.3, 0.42, 0.4999}) {
    const UnitLaw law = unit_law(nu, {});
    const VoigtMatrix P = PlaneLaw(law.D, law.kappa).at(Vec3::UnitZ());
    VoigtMatrix exact = VoigtMatrix::Zero();
    exact(0, 0) = exact(1, 1) = 1 / (1 - nu * nu);
    exact(0, 1) = exact(1, 0) = nu / (1 - nu * nu);
    exact(3, 3) = 0.5 / (1 + nu);
    EXPECT_LT((P - exact).norm(), 1e-10 * law.kappa + 1e-12) << nu;
  }
}

// Backus (1962), eq. 13: the five constants of thin isotropic layers across z.
TEST(Laminate, ItIsBackussOfThinLayers) {
  const UnitLaw law = unit_law(kLaminateNu, {});
  const double q[] = {1.0, 7.0}, share[] = {0.65, 0.35};
  double A = 0, by_H = 0, m = 0, per_m = 0, l_per_m = 0, plane = 0, per_mu = 0, mu_mean = 0;
  for (int k = 0; k < 2; ++k) {
    const double lambda = q[k] * kLaminateNu / ((1 + kLaminateNu) * (1 - 2 * kLaminateNu)),
                 mu = q[k] / (2 * (1 + kLaminateNu));
    m = lambda + 2 * mu;
    A += share[k] * q[k];
    by_H += share[k] / q[k];
    per_m += share[k] / m;
    l_per_m += share[k] * lambda / m;
    plane += share[k] * 4 * mu * (lambda + mu) / m;
    per_mu += share[k] / mu;
    mu_mean += share[k] * mu;
  }
  const VoigtMatrix mine =
      full(law) / by_H + (A - 1 / by_H) * PlaneLaw(law.D, law.kappa).at(Vec3::UnitZ());
  const double c33 = 1 / per_m, c13 = l_per_m / per_m, c11 = plane + l_per_m * l_per_m / per_m;
  EXPECT_NEAR(mine(0, 0), c11, 1e-9 * c11);
  EXPECT_NEAR(mine(2, 2), c33, 1e-9 * c11);
  EXPECT_NEAR(mine(0, 2), c13, 1e-9 * c11);
  EXPECT_NEAR(mine(3, 3), mu_mean, 1e-9 * c11);
  EXPECT_NEAR(mine(4, 4), 1 / per_mu, 1e-9 * c11);
  EXPECT_NEAR(mine(0, 1), c11 - 2 * mu_mean, 1e-9 * c11);
}

TEST(Laminate, ItTurnsWithItsLayers) {
  const UnitLaw law = unit_law(kLaminateNu, {});
  const PlaneLaw plane(law.D, law.kappa);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).matrix();
  const VoigtMatrix T = stress_rotation(R);
  EXPECT_LT((plane.at(R.col(2)) - T * plane.at(Vec3::UnitZ()) * T.transpose()).norm(), 1e-12);
}

TEST(Laminate, DerivativesAreThoseOfDifferences) {
  const std::vector<double> transverse{1.8, 0.8, 0.6, 0.5};
  const UnitLaw law = unit_law(kLaminateNu, transverse);
  const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized(), change = n.cross(Vec3(0.2, 0.9, 0.1));
  const PlaneLaw plane(law.D, law.kappa);
  const double h = 1e-6;
  const VoigtMatrix by_normal =
      (plane.at((n + h * change).normalized()) - plane.at((n - h * change).normalized())) / (2 * h);
  EXPECT_LT((plane.by_normal(n, change) - by_normal).norm(), 1e-8 * by_normal.norm());
  const UnitLaw up = unit_law(kLaminateNu + h, transverse),
                down = unit_law(kLaminateNu - h, transverse);
  const VoigtMatrix by_nu =
      (PlaneLaw(up.D, up.kappa).at(n) - PlaneLaw(down.D, down.kappa).at(n)) / (2 * h);
  EXPECT_LT((plane.by_law(n, law.D_by[0], law.kappa_by[0]) - by_nu).norm(), 1e-7 * by_nu.norm());
}

TEST(Laminate, TheNormalIsTheBoundarys) {
  const TetMesh mesh = test::block_mesh({1, 1, 1}, 2, 2, 2, 1);
  const auto level = [](double shift) -> LevelSet {
    return [shift](const Vec3& p) {
      const Vec3 normal(1 + shift, 2, 2);
      LevelValue at{normal.dot(p) - 1, Eigen::VectorXd::Constant(1, p.x()), 0};
      return at;
    };
  };
  const BoundaryNormal exact = boundary_normal(mesh, 3, level(0));
  EXPECT_LT((exact.normal - Vec3(1, 2, 2) / 3).norm(), 1e-12);
  const Vec3 difference = (boundary_normal(mesh, 3, level(1e-6)).normal -
                           boundary_normal(mesh, 3, level(-1e-6)).normal) /
                          2e-6;
  EXPECT_LT((exact.by_parameters.col(0) - difference).norm(), 1e-8);
}

TEST(Laminate, QuotientsNearZero) {
  for (const double x : {1e-12, 1e-6, 5e-4, 2e-3, 0.7, 6.0}) {
    EXPECT_NEAR(expm1_over(x), (std::expm1(x)) / x, 1e-9 * expm1_over(x)) << x;
    const double h = 1e-4 * (1 + x);
    EXPECT_NEAR(expm1_over_slope(x), (expm1_over(x + h) - expm1_over(x - h)) / (2 * h),
                1e-6 * expm1_over_slope(x))
        << x;
  }
}

}  // namespace
}  // namespace hapsim
