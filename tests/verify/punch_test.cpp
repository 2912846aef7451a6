// A rigid flat punch on a half-space that sticks to it, or does not rub at all.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solid/elastic_body.h"
#include "support/half_space.h"

namespace hapsim {
namespace {

struct Punch {
  double bonded = 0, frictionless = 0;  // force of a unit depth, E = 1 and radius 1
};

// Every node under the punch is moved by itself: K between them, of which the bonded punch moves
// all by the same z and nothing sideways, and the frictionless one leaves the sideways forces zero.
Punch punch(const ContactMesh& contact, double nu) {
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  int count = 0;
  for (const int n : contact.patch_nodes) handle[n] = count++;
  ElasticBody body(contact.mesh, handle, Dilatation::kElement);
  body.factorise(std::vector<Lame>(contact.mesh.tets.size(), lame(1, nu)));
  const Eigen::MatrixXd K = body.solve(Eigen::MatrixXd::Identity(3 * count, 3 * count)).reaction;
  Eigen::MatrixXd across(3 * count, 2 * count), down(3 * count, count);
  for (int n = 0; n < count; ++n) {
    across.col(2 * n) = K.col(3 * n);
    across.col(2 * n + 1) = K.col(3 * n + 1);
    down.col(n) = K.col(3 * n + 2);
  }
  const auto rows = [count](const Eigen::MatrixXd& m, bool z) {
    Eigen::MatrixXd part(z ? count : 2 * count, m.cols());
    for (int n = 0; n < count; ++n)
      if (z)
        part.row(n) = m.row(3 * n + 2);
      else
        part.middleRows(2 * n, 2) = m.middleRows(3 * n, 2);
    return part;
  };
  const Eigen::VectorXd unit = Eigen::VectorXd::Ones(count);
  const Eigen::VectorXd sideways = rows(across, false).ldlt().solve(rows(down, false) * unit);
  Punch result;
  result.bonded = unit.dot(rows(down, true) * unit);
  result.frictionless = result.bonded - unit.dot(rows(across, true) * sideways);
  return result;
}

// Without friction F = 2 a E d/(1 - nu^2) (Boussinesq, 1885; Johnson, Contact Mechanics, 3.36);
// bonded F = 4 mu a d log(3 - 4 nu)/(1 - 2 nu) (Mossakovskii, 1954; Johnson 3.8). The finite block
// makes both stiffer by about a / (2 far).
TEST(Punch, IsTheHalfSpaces) {
  constexpr double kReach = 200;
  const ContactMesh meshes[] = {test::half_space(1.0 / 3, kReach),
                                test::half_space(1.0 / 6, kReach)};
  for (const double nu : {0.0, 0.3, 0.49}) {
    const double slips = 2 / (1 - nu * nu);
    const double sticks = 2 / (1 + nu) * std::log(3 - 4 * nu) / (1 - 2 * nu);
    const Punch coarse = punch(meshes[0], nu), fine = punch(meshes[1], nu);
    std::printf(
        "punch nu %.2f: frictionless %.4f (rim twice as coarse %.4f), bonded %.4f (%.4f) of the "
        "exact\n",
        nu, fine.frictionless / slips, coarse.frictionless / slips, fine.bonded / sticks,
        coarse.bonded / sticks);
    const double block = 1 + 1 / (2 * kReach);
    EXPECT_NEAR(fine.frictionless / slips, block, 0.015);
    EXPECT_NEAR(fine.bonded / sticks, block, 0.02);
    EXPECT_LT(fine.frictionless, fine.bonded);
  }
}

}  // namespace
}  // namespace hapsim
