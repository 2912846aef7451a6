// The torque of a bonded flat tool that is moved: reciprocity, symmetry, derivatives, frames.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

#include "contact/rigid_stiffness.h"
#include "contact/tool_torque_solution.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kTorqueRadius = 0.004;

TetMesh torque_block() {
  return test::block_mesh({0.06, 0.06, 0.03}, 8, 8, 6, 1);
}

ContactMesh torque_contact(const ContactBase& base, const Vec3& point) {
  return make_contact_mesh(base, point, kTorqueRadius, kTorqueRadius / 3, 0.8);
}

Eigen::Matrix3d lever(const TorqueSolution& s) {
  return s.T * s.K.inverse();
}

const Vec3 kMiddle(0.03, 0.03, 0.03), kTorqueEdge(0.055, 0.03, 0.03);

// The moment under a moved tool is the force under a turned one (Betti), from nodal tractions here
// and from energies there.
TEST(ToolTorque, IsReciprocal) {
  const ContactBase base = make_contact_base(torque_block());
  const ContactMesh contact = torque_contact(base, kTorqueEdge);
  const TorqueSolution s = solve_torque(contact, {0.4, {2000.0}, nullptr, {}});
  const std::vector<Lame> constants(contact.mesh.tets.size(), lame(2000, 0.4));
  const Eigen::MatrixXd K =
      rigid_stiffness(contact.mesh, {{contact.patch_nodes, contact.point}}, constants);
  EXPECT_LT((s.K - K.topLeftCorner(3, 3)).norm(), 1e-8 * s.K.norm());
  EXPECT_LT((s.T - K.bottomLeftCorner(3, 3)).norm(), 1e-8 * s.T.norm());
  EXPECT_LT((s.T.transpose() - K.topRightCorner(3, 3)).norm(), 1e-8 * s.T.norm());
}

// In the middle of a square block nothing but the moment about n x u is left; near an edge the
// press along the normal has a moment too, and the plane of symmetry leaves its others zero.
TEST(ToolTorque, HasTheSymmetryOfThePlace) {
  const ContactBase base = make_contact_base(torque_block());
  const Material material{0.4, {1.0}, nullptr, {}};
  const Eigen::Matrix3d middle = lever(solve_torque(torque_contact(base, kMiddle), material));
  const double sway = 0.5 * (middle(1, 0) - middle(0, 1));
  EXPECT_GT(std::abs(sway), 0.02 * kTorqueRadius);
  Eigen::Matrix3d rest = middle;
  rest(1, 0) -= sway;
  rest(0, 1) += sway;
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 0.02 * kTorqueRadius);
  const Eigen::Matrix3d edge = lever(solve_torque(torque_contact(base, kTorqueEdge), material));
  EXPECT_GT(std::abs(edge(1, 2)), 0.03 * kTorqueRadius);
  for (const auto& [i, j] : {std::pair{0, 0}, {0, 2}, {1, 1}, {2, 0}, {2, 2}})
    EXPECT_LT(std::abs(edge(i, j)), 0.02 * kTorqueRadius) << i << j;
}

// Incompressible, a bonded disc on a half-space slides and tilts apart; so nearly does one on a
// block of some radii.
TEST(ToolTorque, OfAnIncompressibleHalfSpaceIsNone) {
  const ContactBase base = make_contact_base(test::block_mesh({0.4, 0.4, 0.2}, 8, 8, 6, 1));
  const auto sway = [&](double nu) {
    const Eigen::Matrix3d L = lever(solve_torque(
        make_contact_mesh(base, {0.2, 0.2, 0.2}, kTorqueRadius, kTorqueRadius / 6, 0.4),
        {nu, {1.0}, nullptr, {}}));
    return 0.5 * std::abs(L(1, 0) - L(0, 1)) / kTorqueRadius;
  };
  const double none = sway(0.4999), some = sway(0.3);
  std::printf("lever over radius: %.5f at nu 0.4999, %.5f at 0.3\n", none, some);
  constexpr double kMesh = 0.005;  // what the meshes are good for
  EXPECT_LT(none, kMesh);
  // The strip's index e = log(3 - 4 nu) / (2 pi) times the radius, to some per cent
  // (rocking_test.cpp).
  EXPECT_NEAR(some, std::log(1.8) / (2 * std::acos(-1.0)), kMesh);
}

TEST(ToolTorque, DerivativesAreDifferences) {
  const ContactBase base = make_contact_base(torque_block());
  const ContactMesh contact = torque_contact(base, kTorqueEdge);
  const auto group = [](const Vec3& p) { return p.x() > 0.052 ? 1 : 0; };
  const auto solve = [&](double nu, double beside) {
    return solve_torque(contact, {nu, {1000.0, beside}, group, {}});
  };
  const TorqueSolution at = solve(0.35, 3000);
  const double step = 1e-4, dE = 1;
  const TorqueSolution up = solve(0.35 + step, 3000), down = solve(0.35 - step, 3000);
  const Eigen::Matrix3d by_nu = (up.T - down.T) / (2 * step);
  EXPECT_LT((at.dT_dnu - by_nu).norm(), 1e-5 * by_nu.norm());
  EXPECT_LT((at.dK_dnu - (up.K - down.K) / (2 * step)).norm(), 1e-5 * at.dK_dnu.norm());
  const Eigen::Matrix3d by_E = (solve(0.35, 3000 + dE).T - solve(0.35, 3000 - dE).T) / (2 * dE);
  EXPECT_LT((at.dT_dmodulus[1] - by_E).norm(), 1e-5 * by_E.norm());
  EXPECT_LT((1000 * at.dT_dmodulus[0] + 3000 * at.dT_dmodulus[1] - at.T).norm(),
            1e-10 * at.T.norm());
}

// A body that is turned has its levers turned.
TEST(ToolTorque, TurnsWithTheBody) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  TetMesh turned = torque_block();
  for (Vec3& p : turned.nodes) p = (R * p).eval();
  const Material material{0.4, {1.0}, nullptr, {}};
  const Eigen::Matrix3d L =
      lever(solve_torque(torque_contact(make_contact_base(torque_block()), kTorqueEdge), material));
  const Eigen::Matrix3d L_turned =
      lever(solve_torque(torque_contact(make_contact_base(turned), R * kTorqueEdge), material));
  EXPECT_LT((L_turned - R * L * R.transpose()).cwiseAbs().maxCoeff(), 0.02 * kTorqueRadius);
}

TEST(ToolTorque, IsAnEntryOfTheCache) {
  const ContactBase base = make_contact_base(torque_block());
  const TorqueSolution s =
      solve_torque(torque_contact(base, kTorqueEdge),
                   {0.4, {1.0, 2.0}, [](const Vec3& p) { return p.x() > 0.05 ? 1 : 0; }, {}});
  const auto back = unpacked(packed(s));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->T, s.T);
  EXPECT_EQ(back->K, s.K);
  EXPECT_EQ(back->dT_dnu, s.dT_dnu);
  EXPECT_EQ(back->coarse_T, s.coarse_T);
  ASSERT_EQ(back->dT_dmodulus.size(), 2u);
  EXPECT_EQ(back->dT_dmodulus[1], s.dT_dmodulus[1]);
  EXPECT_FALSE(unpacked(StiffnessSolution{}));
}

}  // namespace
}  // namespace hapsim
