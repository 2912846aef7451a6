// The law of a tool wider than declared against contact meshes of both radii.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "contact/contact_stiffness.h"
#include "effects/effects.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.004;
using Forces = Eigen::Matrix3d;  // on the tool, a column each for the motions x, y, -z

Forces law(const StiffnessSolution& s, double nu, double wider) {
  PressView press;
  press.u = {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitZ()};
  press.in_air.assign(3, 0);
  press.radius = kRadius;
  press.normal = s.normal;
  press.contact.K = s.K;
  press.contact.modulus = 1;
  press.contact.nu = nu;
  Signal signal{Eigen::VectorXd(9), Eigen::MatrixXd(9, 0)};
  for (int i = 0; i < 3; ++i) signal.f.segment<3>(3 * i) = -s.K * press.u[i];
  tool_radius_effect().apply(press, {{0, "s", wider}}, signal);
  return Forces(signal.f.data());
}

// The largest error of the law over the largest force, for a tool of twice the radius pressed at x
// from the middle of a block `deep` thick; printed beside that of a force in proportion to it.
double error(double deep, double x, double nu) {
  const ContactBase base = make_contact_base(test::block_mesh({0.1, 0.1, deep}, 8, 8, 6, 1));
  const auto solve = [&](double radius) {
    ContactBodies bodies(base, {0.05 + x, 0.05, deep}, radius);
    return bodies.solve({nu, {1.0}, nullptr}, plan_grid(base.surface));
  };
  const StiffnessSolution declared = solve(kRadius), wide = solve(2 * kRadius);
  const Forces truth = -wide.K * Eigen::Vector3d(1, 1, -1).asDiagonal().toDenseMatrix();
  const auto off = [&](const Forces& f) {
    return (f - truth).cwiseAbs().maxCoeff() / truth.cwiseAbs().maxCoeff();
  };
  const double by_law = off(law(declared, nu, 2));
  std::printf("%.0f mm deep, %.0f mm aside, nu %.2f: law %.2f %%, in proportion %.2f %%\n",
              1e3 * deep, 1e3 * x, nu, 100 * by_law, 100 * off(2 * law(declared, nu, 1)));
  return by_law;
}

// As the card says.
TEST(ToolRadius, IsTheWiderToolOnABlock) {
  EXPECT_LT(error(0.05, 0, 0.3), 0.015);
  EXPECT_LT(error(0.05, 0, 0.48), 0.015);
  EXPECT_LT(error(0.05, 0.03, 0.4), 0.015);
  EXPECT_LT(error(0.024, 0, 0.3), 0.03);
  EXPECT_LT(error(0.012, 0, 0.3), 0.08);
}

}  // namespace
}  // namespace hapsim
