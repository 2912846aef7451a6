// The laws of the material under the tool against finite elements.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effects.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "nonlinear/sphere_contact.h"
#include "support/block_mesh.h"
#include "support/bonded_tool.h"

namespace hapsim {
namespace {

constexpr double kRadius = 1;  // of the tool; lengths in it, forces in E

// A block, `wide` and `deep`, bonded at its base, with the tool bonded to the middle of its top.
struct Block : test::BondedTool {
  Block(double wide, double deep, double rim)
      : BondedTool(
            make_contact_mesh(make_contact_base(test::block_mesh({wide, wide, deep}, 8, 8, 4, 1)),
                              {wide / 2, wide / 2, deep}, kRadius, rim, 2.4 * rim)) {}
};

PressView press_of(const std::vector<Vec3>& path, double nu, const Eigen::Matrix3d& K) {
  PressView press;
  press.u = path;
  press.in_air.assign(path.size(), 0);
  press.radius = kRadius;
  press.contact.K = K;
  press.contact.modulus = 1;
  press.contact.nu = nu;
  return press;
}

// s of the exponential law's b, as the effect's card states it.
double stiffening(double b) {
  return 0.149 * std::pow(b, 1 / 1.6);
}

// Finite strain of an exponential law, down and then sideways.
TEST(ContactLaw, HyperelasticIsTheFiniteStrainOfAHalfSpace) {
  const Block block(24, 12, 0.25);
  const double nu = 0.4;
  const std::vector<Vec3> path{{0, 0, -0.5}, {0, 0, -1}, {0.3, 0, -1}};
  for (const double b : {1.0, 3.0}) {
    const Moduli m = moduli(1, nu);
    NonlinearBody body = block.body(exponential_law(m.mu, b, m.bulk));
    const PressView press = press_of(path, nu, body.linearise().K);
    Signal signal{Eigen::VectorXd(9), Eigen::MatrixXd(9, 0)};
    for (int i = 0; i < 3; ++i) signal.f.segment<3>(3 * i) = -press.contact.K * path[i];
    const Eigen::VectorXd linear = signal.f;
    hyperelastic_effect().apply(press, {{0, "s", stiffening(b)}, {0, "finite", 1}}, signal);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(body.solve(path[i]).ok());
      const Vec3 force = -body.reaction();
      std::printf(
          "b %.0f, way (%.1f, %.1f): elements (%.4f, %.4f), law (%.4f, %.4f), linear (%.4f, "
          "%.4f)\n",
          b, path[i].x(), -path[i].z(), force.x(), force.z(), signal.f[3 * i], signal.f[3 * i + 2],
          linear[3 * i], linear[3 * i + 2]);
      EXPECT_LT((signal.f.segment<3>(3 * i) - force).norm(), 0.02 * force.norm());
    }
  }
}

// The tip's law knows the flat tool's stiffness only; here against contact by elements on a block
// that is far from a half-space. Without friction there and bonded here, so nu near 1/2.
TEST(ContactLaw, TipIsTheSphereOnABlock) {
  const double wide = 12, deep = 5, R = 20, nu = 0.49;
  const Block flat(wide, deep, 1.0 / 6);
  const Eigen::Matrix3d K = flat.body(isotropic_law(1, nu)).linearise().K;
  // Edges of a twentieth of the radius in the middle, a fifth at the border of the smallest contact
  // (coordinates graded by sinh).
  constexpr int kCells = 24, kLayers = 9;
  TetMesh mesh = test::block_mesh({2, 2, 1}, kCells, kCells, kLayers, 1);
  const auto graded = [](double s, double reach, double k) {
    return reach * std::sinh(k * s) / std::sinh(k);
  };
  for (Vec3& p : mesh.nodes)
    p = {graded(p.x() - 1, wide / 2, 4.5), graded(p.y() - 1, wide / 2, 4.5),
         -graded(1 - p.z(), deep, 4)};
  mesh = to_second_order(mesh);
  BodyModel model{&mesh, {isotropic_law(1, nu)}};
  model.dilatation = Dilatation::kElement;
  SphereContact sphere(model, mesh.fixed, Vec3::Zero(), Vec3::UnitZ(), 1.25);
  const double half_space = 4.0 / 3 / (1 - nu * nu);
  for (const double share : {0.25, 0.5, 1.0}) {
    const double depth = share * kRadius * kRadius / R;
    const PressView press = press_of({{0, 0, -depth}}, nu, K);
    Motion motion{press.u, {}, 0};
    tip_effect().move(press, {{0, "kappa", 1 / R}}, motion);
    const double law = -(K * motion.u[0]).z(), elements = sphere.press(R, depth).force;
    std::printf("depth %.4f: law / elements %.4f, Hertz / elements %.4f\n", depth, law / elements,
                half_space * std::sqrt(R) * std::pow(depth, 1.5) / elements);
    EXPECT_NEAR(law / elements, 1, 0.01);
  }
}

}  // namespace
}  // namespace hapsim
