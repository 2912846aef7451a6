// NAFEMS's benchmark LE10 on curved second-order tetrahedra.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "material/hooke_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "solid/surface_load.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;

// Displacement gradient of one element at its corner `c` (isoparametric).
Matrix3d gradient_at_corner(const TetMesh& mesh, std::size_t tet, int c,
                            const Eigen::VectorXd& field) {
  Eigen::Matrix<double, 4, 10> by_l = Eigen::Matrix<double, 4, 10>::Zero();
  for (int a = 0; a < 4; ++a) by_l(a, a) = a == c ? 3 : -1;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kTetEdges[e];
    if (j == c) by_l(i, 4 + e) = 4;
    if (i == c) by_l(j, 4 + e) = 4;
  }
  const Eigen::Matrix<double, 3, 10> local = by_l.bottomRows<3>().rowwise() - by_l.row(0);
  Matrix3d J = Matrix3d::Zero(), H = Matrix3d::Zero();
  for (int a = 0; a < 10; ++a) {
    J += mesh.nodes[mesh.tets[tet][a]] * local.col(a).transpose();
    H += field.segment<3>(3 * mesh.tets[tet][a]) * local.col(a).transpose();
  }
  return H * J.inverse();
}

// Thick elliptic plate (NAFEMS, The Standard NAFEMS Benchmarks, 1990, LE10): inner ellipse 2 x 1,
// outer 3.25 x 2.75, 0.6 thick [m]; E = 210 GPa, nu = 0.3; pressure 1 MPa on top; a quarter with
// planes of symmetry, the outer rim held in the plane and, at half the thickness, upright. Target:
// sigma_yy = -5.38 MPa at D = (2, 0, 0.6). In units of 1 MPa.
double stress_at_D(int n) {
  TetMesh mesh = test::block_mesh({1, 1, 1}, n, n, std::max(2, n / 2), 2);
  const std::vector<Vec3> parameter = mesh.nodes;
  for (Vec3& p : mesh.nodes) {
    const double angle = M_PI / 2 * p.y();
    p = {(2 + 1.25 * p.x()) * std::cos(angle), (1 + 1.75 * p.x()) * std::sin(angle), 0.6 * p.z()};
  }
  constexpr double kModulus = 210e3, kRatio = 0.3, kStiff = 1e9;
  BodyModel model{&mesh, {isotropic_law(kModulus, kRatio)}};
  const auto slide = [&](std::size_t i, const Vec3& direction) {
    model.springs.push_back({static_cast<int>(i), kStiff * direction * direction.transpose()});
  };
  std::size_t corner = 0;
  for (std::size_t i = 0; i < parameter.size(); ++i) {
    const Vec3& p = parameter[i];
    if (p.y() < 1e-9) slide(i, Vec3::UnitY());
    if (p.y() > 1 - 1e-9) slide(i, Vec3::UnitX());
    if (p.x() > 1 - 1e-9) {
      slide(i, Vec3::UnitX());
      slide(i, Vec3::UnitY());
      if (std::abs(p.z() - 0.5) < 1e-9) slide(i, Vec3::UnitZ());
    }
    if ((p - Vec3(0, 0, 1)).norm() < 1e-9) corner = i;
  }
  std::vector<Triangle> top;
  for (const Triangle& f : mesh.faces)
    if (parameter[f[0]].z() + parameter[f[1]].z() + parameter[f[2]].z() > 3 - 1e-9)
      top.push_back(f);
  NonlinearBody body(model, std::vector<int>(mesh.nodes.size(), kFreeNode));
  body.set_load(pressure_load(mesh, top, 1));
  EXPECT_TRUE(body.solve(Eigen::VectorXd(), {1e-6}).ok());
  Matrix3d H = Matrix3d::Zero();
  int count = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int c = 0; c < 4; ++c)
      if (mesh.tets[t][c] == static_cast<int>(corner)) {
        H += gradient_at_corner(mesh, t, c, body.field());
        ++count;
      }
  return nominal_stress(*model.laws[0], Matrix3d::Identity() + H / count)(1, 1);
}

TEST(Nafems, ThickPlateLE10) {
  const double coarse = stress_at_D(8), fine = stress_at_D(16);
  const double rate = std::log2(std::abs(coarse + 5.38) / std::abs(fine + 5.38));
  std::printf("LE10: sigma_yy at D %.3f MPa (coarser %.3f), target -5.38, rate %.2f\n", fine,
              coarse, rate);
  // Raw stresses of the elements at a corner where they change fast: 1.7 % off at 16 cells along
  // each side, and closing in.
  EXPECT_NEAR(fine, -5.38, 0.02 * 5.38);
  EXPECT_GT(rate, 0.6);
}

}  // namespace
}  // namespace hapsim
