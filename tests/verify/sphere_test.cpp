// A spherical tip on a half-space and on a bonded layer.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "nonlinear/sphere_contact.h"
#include "support/graded_block.h"

namespace hapsim {
namespace {

struct Prepared {
  TetMesh mesh;
  Prepared(double L, double depth, double edge, int n, int layers)
      : mesh(test::graded_block(L, depth, edge, n, layers)) {}
  SphereContact on(double nu, double a) const {
    BodyModel model{&mesh, {isotropic_law(1, nu)}};
    model.dilatation = Dilatation::kElement;
    return {model, mesh.fixed, Vec3::Zero(), Vec3::UnitZ(), 2.5 * a};
  }
};

double hertz(double nu, double R, double depth) {
  return 4.0 / 3 / (1 - nu * nu) * std::sqrt(R) * std::pow(depth, 1.5);
}

constexpr double kFar = 80;  // half width and depth of the half-space's block, contact radius 1

// Hertz, J. reine angew. Math. 92, 1882 (Johnson, Contact Mechanics, 4.22): F = 4/3 E/(1 - nu^2)
// sqrt(R) d^(3/2), contact radius sqrt(R d). The tip is shallow (a/R = 0.05), so it is a
// paraboloid. The finite block alone makes it stiffer by about a / kFar / 2 = 0.6 %.
TEST(Sphere, IsHertzOnAHalfSpace) {
  const Prepared coarse(kFar, kFar, 0.45, 12, 6), fine(kFar, kFar, 0.22, 16, 8);
  for (const double nu : {0.3, 0.49}) {
    const double R = 20, depth = 1 / R;
    const auto ratios = [&](const Prepared& p) {
      const SpherePress s = p.on(nu, 1).press(R, depth);
      EXPECT_TRUE(s.fits);
      EXPECT_NEAR(s.stiffness * depth / s.force, 1.5, 0.08);
      return Eigen::Vector2d(s.force / hertz(nu, R, depth), s.contact_radius);
    };
    const Eigen::Vector2d c = ratios(coarse), f = ratios(fine);
    std::printf("Hertz nu %.2f: force %.4f (coarser %.4f), contact radius %.4f (coarser %.4f)\n",
                nu, f[0], c[0], f[1], c[1]);
    EXPECT_NEAR(f[0], 1, 0.02);
    // Hats reach over the border, where edges are 0.66 long here: an error of second order in them.
    EXPECT_NEAR(f[1], 1, 0.2 * 0.66 * 0.66);
    EXPECT_LT(std::abs(f[0] - 1), std::abs(c[0] - 1));
    EXPECT_LT(std::abs(f[1] - 1), std::abs(c[1] - 1));
  }
}

// The exact sphere pressed deep: Sneddon, Int. J. Eng. Sci. 3, 1965, with contact radius a:
// d = a/2 log((R + a)/(R - a)), F = E/(1 - nu^2) ((R^2 + a^2)/2 log((R + a)/(R - a)) - a R).
TEST(Sphere, IsSneddonsWhenDeep) {
  const Prepared fine(kFar, kFar, 0.22, 16, 8);
  const double nu = 0.4, a = 1, R = a / 0.6, log_ratio = std::log((R + a) / (R - a));
  const double depth = a / 2 * log_ratio;
  const double force = 1 / (1 - nu * nu) * ((a * a + R * R) / 2 * log_ratio - a * R);
  const double found = fine.on(nu, a).press(R, depth).force;
  std::printf("Sneddon / Hertz %.4f, force / Sneddon %.4f\n", force / hertz(nu, R, depth),
              found / force);
  EXPECT_NEAR(found / force, 1, 0.02);
}

// A bonded layer of thickness h: Dimitriadis et al., Biophys. J. 82, 2002, eq. 12, a series to
// fourth order in chi = sqrt(R d)/h whose own rest is some chi^5: 2 % at 0.3.
TEST(Sphere, IsDimitriadisOnABondedLayer) {
  const double a = 1;
  for (const double chi : {0.3}) {
    const double h = a / chi, R = 20, depth = a * a / R;
    const Prepared layer(40, h, 0.22, 16, 8);
    for (const double nu : {0.3, 0.45}) {
      const double a0 = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1 - nu);
      const double b0 = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1 - nu);
      const double t = 2 / M_PI * chi;
      const double factor = 1 - a0 * t + a0 * a0 * t * t -
                            (std::pow(a0, 3) + 4 * M_PI * M_PI / 15 * b0) * t * t * t +
                            a0 * (std::pow(a0, 3) + 3 * M_PI * M_PI / 5 * b0) * std::pow(t, 4);
      const double found = layer.on(nu, a).press(R, depth).force / hertz(nu, R, depth);
      std::printf("layer nu %.2f chi %.2f: force / Hertz %.4f, Dimitriadis %.4f\n", nu, chi, found,
                  factor);
      EXPECT_NEAR(found / factor, 1, 0.03);
    }
  }
}

TEST(Sphere, DerivativesAreTheDifferences) {
  const Prepared p(10, 10, 0.4, 8, 4);
  const double R = 5, depth = 0.2, nu = 0.4;
  SphereContact contact = p.on(nu, 1);
  const SpherePress s = contact.press(R, depth);
  const double h = 1e-6;
  const double by_depth =
      (contact.press(R, depth + h).force - contact.press(R, depth - h).force) / (2 * h);
  EXPECT_NEAR(s.stiffness, by_depth, 1e-5 * by_depth);
  const double k = 1e-5;
  const double by_radius =
      (contact.press(R + k, depth).force - contact.press(R - k, depth).force) / (2 * k);
  EXPECT_NEAR(s.by_radius, by_radius, 1e-5 * std::abs(by_radius));
  EXPECT_NEAR(s.by_constants[0][0], s.force, 1e-9 * s.force);  // E = 1
  const double by_nu =
      (p.on(nu + 1e-6, 1).press(R, depth).force - p.on(nu - 1e-6, 1).press(R, depth).force) / 2e-6;
  EXPECT_NEAR(s.by_constants[0][1], by_nu, 1e-5 * std::abs(by_nu));
  EXPECT_EQ(contact.press(R, 0).force, 0);
  EXPECT_EQ(contact.press(R, -0.001).force, 0);
}

}  // namespace
}  // namespace hapsim
