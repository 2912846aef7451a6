// Rigid flat punches on a half-space that are turned: closed forms, and what the live torque takes.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "contact/rigid_stiffness.h"
#include "contact/tool_torque_solution.h"
#include "realtime/disc_rotation.h"
#include "solid/elastic_body.h"
#include "support/half_space.h"

namespace hapsim {
namespace {

std::vector<Lame> uniform(const ContactMesh& contact, double nu) {
  return std::vector<Lame>(contact.mesh.tets.size(), lame(1, nu));
}

// Moment that turns a punch without friction by a unit angle about x; radius 1, E = 1.
double frictionless_rocking(const ContactMesh& contact, double nu) {
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  int count = 0;
  for (const int n : contact.patch_nodes) handle[n] = count++;
  ElasticBody body(contact.mesh, handle, Dilatation::kElement);
  body.factorise(uniform(contact, nu));
  const Eigen::MatrixXd K = body.solve(Eigen::MatrixXd::Identity(3 * count, 3 * count)).reaction;
  Eigen::MatrixXd side(2 * count, 2 * count), both(2 * count, count), down(count, count);
  Eigen::VectorXd tilt(count);
  for (int a = 0; a < count; ++a) {
    tilt[a] = contact.mesh.nodes[contact.patch_nodes[a]].y();  // about the origin
    for (int b = 0; b < count; ++b) {
      side.block<2, 2>(2 * a, 2 * b) = K.block<2, 2>(3 * a, 3 * b);
      both.block<2, 1>(2 * a, b) = K.block<2, 1>(3 * a, 3 * b + 2);
      down(a, b) = K(3 * a + 2, 3 * b + 2);
    }
  }
  return tilt.dot(down * tilt) - (both * tilt).dot(side.ldlt().solve(both * tilt));
}

// Without friction 8 G a^3 / (3 (1 - nu)), twisted 16 G a^3 / 3; bonded there is no closed form,
// and what the live torque takes is laid beside the elements.
TEST(Rocking, IsTheHalfSpaces) {
  // Moments die away with the cube of the distance: the block is large enough.
  ContactMesh contact = test::half_space(1.0 / 6, 40);
  contact.point.setZero();
  for (const double nu : {0.0, 0.4, 0.49}) {
    const double G = 0.5 / (1 + nu);
    const Matrix6 K = rigid_stiffness(contact.mesh, {{contact.patch_nodes, contact.point}},
                                      uniform(contact, nu)) /
                      G;
    const DiscRotation disc = bonded_disc_rotation(nu);
    std::printf("nu %.2f: torsion %.4f, rocking %.4f, sway %.4f of the half-space's\n", nu,
                K(5, 5) / disc.torsion, K(3, 3) / disc.rocking, K(4, 0) / disc.sway);
    EXPECT_NEAR(K(5, 5) / disc.torsion, 1, 0.015);
    EXPECT_NEAR(K(3, 3) / disc.rocking, 1, 0.03);
    EXPECT_NEAR(K(4, 0), disc.sway, 0.02 * K(0, 0));
    EXPECT_NEAR(K(3, 1), -disc.sway, 0.02 * K(0, 0));
  }
  const ContactMesh coarse = test::half_space(1.0 / 3, 40);
  const double slips = frictionless_rocking(coarse, 0.3) * 2.6 * 3 * 0.7 / 8;
  std::printf("without friction, rim twice as coarse: %.4f of the half-space's\n", slips);
  EXPECT_NEAR(slips, 1, 0.04);
}

// The batch mode's lever on a half-space is the live mode's: same pole, same sign.
TEST(Rocking, BatchAndLiveHaveOneLever) {
  ContactMesh contact = test::half_space(1.0 / 6, 40);
  contact.point.setZero();
  for (const double nu : {0.2, 0.4, 0.49}) {
    const TorqueSolution s = solve_torque(contact, {nu, {1.0}, nullptr, {}});
    const Eigen::Matrix3d batch = s.T * s.K.inverse();
    const Matrix6 K = disc_stiffness(s.K, 1, nu, 1, Vec3::UnitZ());
    const Eigen::Matrix3d live = K.bottomLeftCorner<3, 3>() * K.topLeftCorner<3, 3>().inverse();
    std::printf("nu %.2f: lever over radius %.4f in batch, %.4f live\n", nu, batch(1, 0),
                live(1, 0));
    EXPECT_LT((batch - live).cwiseAbs().maxCoeff(), 0.01);
  }
}

}  // namespace
}  // namespace hapsim
