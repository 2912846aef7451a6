// Bodies between plates against closed forms and finite-strain elements.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "effects/effects.h"
#include "effects/plates_law.h"
#include "import/block.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "support/bonded_tool.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 1;  // of the cylinder; forces in E
const double kArea = M_PI;

// A cylinder bonded to both plates.
struct Plates : test::BondedTool {
  double height;
  explicit Plates(double high, double finer = 1)
      : BondedTool(
            make_contact_mesh(make_contact_base(make_body_mesh(
                                  block_surface({{2 * kRadius, 2 * kRadius, high}, true}), {})),
                              {0, 0, high}, 2 * kRadius, 2 * kRadius / 6 / finer, 0.4 / finer)),
        height(high) {}
  double stiffness(double nu) const { return body(isotropic_law(1, nu)).linearise().K(2, 2); }
};

// Without lateral contraction plates change nothing: K = E A/h.
TEST(Plates, AreABarWhereNuIsZero) {
  for (const double height : {0.7, 1.2, 3.0})
    EXPECT_NEAR(Plates(height).stiffness(0) * height / kArea, 1, 2e-3) << height;
}

// Nearly incompressible and flat: E_a = E (1 + 2 S^2), S = radius/(2 height) (Gent and Lindley,
// Proc. Inst. Mech. Eng. 173, 1959), a theory that leaves some per cent.
TEST(Plates, StiffenAsGentAndLindley) {
  for (const double height : {0.35, 0.5}) {
    const double S = kRadius / (2 * height);
    const double apparent = Plates(height).stiffness(0.4995) * height / kArea;
    std::printf("height %.2f: elements %.3f, Gent and Lindley %.3f\n", height, apparent,
                1 + 2 * S * S);
    EXPECT_NEAR(apparent / (1 + 2 * S * S), 1, 0.1);
  }
}

TEST(Plates, TheMeshHasConverged) {
  for (const double height : {0.7, 3.0}) {
    const double nu = 0.45;
    const double usual = Plates(height).stiffness(nu), fine = Plates(height, 2).stiffness(nu);
    std::printf("height %.1f: %.4f of the finer mesh's\n", height, usual / fine);
    EXPECT_NEAR(usual / fine, 1, 0.01);
  }
}

// The law's own closed forms: e for small e; incompressible (1/l^2 - l)/3 exp(b I).
TEST(Plates, TheLawIsABars) {
  for (const double nu : {0.3, 0.45, 0.499})
    for (const double b : {0.0, 1.0}) {
      const PlatesLaw law{b, nu};
      EXPECT_NEAR(law.stress(1e-4) / 1e-4, 1, 1e-3);
      EXPECT_NEAR(law.by_strain(0), 1, 1e-6);
    }
  for (const double e : {-0.3, 0.2, 0.5}) {
    const double l = 1 - e, I = l * l + 2 / l - 3;
    EXPECT_NEAR(PlatesLaw({0.5, 0.49999}).stress(e), (1 / (l * l) - l) / 3 * std::exp(0.5 * I),
                1e-3 * std::abs(e));
  }
}

// How far the law is from the elements at strains of 0.1, 0.2 and 0.3, as plates_law.h states.
void expect_law(const Plates& plates, double nu, double b, double early, double deep) {
  const Moduli m = moduli(1, nu);
  NonlinearBody body = plates.body(exponential_law(m.mu, b, m.bulk));
  const double K = body.linearise().K(2, 2);
  std::printf("height %.1f, nu %.2f, b %.1f: law over elements", plates.height, nu, b);
  for (const double e : {0.1, 0.2, 0.3}) {
    const Eigen::VectorXd way = Vec3(0, 0, -e * plates.height);
    ASSERT_TRUE(body.solve(way).ok());
    const double ratio =
        PlatesLaw{b, nu}.stress(e) * K * plates.height / std::abs(body.reaction()[2]);
    std::printf(" %.4f", ratio);
    EXPECT_NEAR(ratio, 1, e < 0.25 ? early : deep);
  }
  std::printf("\n");
}

TEST(Plates, TheLawIsFiniteStrainOfElements) {
  for (const double height : {3.0, 1.2, 0.7}) {
    const Plates plates(height);
    for (const double nu : {0.3, 0.49}) expect_law(plates, nu, 0.5, 0.12, 0.21);
    for (const double b : {0.0, 0.5}) expect_law(plates, 0.45, b, 0.03, 0.08);
    expect_law(plates, 0.45, 2, 0.03, 0.16);
  }
}

// Derivatives of the effect between plates.
TEST(Plates, DerivativesAreDifferences) {
  PressView press;
  press.height = 0.03;
  press.radius = 0.03;
  press.contact.K = Vec3(900, 900, 2000).asDiagonal();
  press.contact.by_column = {{0, press.contact.K / 1e4}};
  press.contact.nu = 0.45;
  press.contact.nu_column = 1;
  press.u = {{0, 0, -1e-3}, {1e-3, 0, -6e-3}, {0, 0, -1.5e-2}};
  press.in_air.assign(3, 0);
  const auto forces = [&](double nu, double s, double scale, int columns) {
    PressView at = press;
    at.contact.nu = nu;
    at.contact.K *= scale;
    at.du = Eigen::MatrixXd::Zero(columns ? 9 : 0, columns);
    Signal signal{Eigen::VectorXd::Zero(9), Eigen::MatrixXd::Zero(9, columns)};
    hyperelastic_effect().apply(at, {{0, "s", s, columns ? 2 : -1}, {0, "finite", 1}}, signal);
    return signal;
  };
  const Signal at = forces(0.45, 0.1, 1, 3);
  const auto difference = [&](double nu, double s, double scale) {
    return Eigen::VectorXd(forces(0.45 + nu, 0.1 + s, 1 + scale, 0).f -
                           forces(0.45 - nu, 0.1 - s, 1 - scale, 0).f);
  };
  const double h = 1e-4;
  EXPECT_LT((difference(0, 0, h) / (2 * h * 1e4) - at.df.col(0)).norm(),
            1e-6 * at.df.col(0).norm());
  EXPECT_LT((difference(h, 0, 0) / (2 * h) - at.df.col(1)).norm(), 1e-4 * at.df.col(1).norm());
  EXPECT_LT((difference(0, h, 0) / (2 * h) - at.df.col(2)).norm(), 1e-4 * at.df.col(2).norm());
}

}  // namespace
}  // namespace hapsim
