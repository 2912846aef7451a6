// A point force on a half-space.
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

// Boussinesq, 1885 (Johnson, Contact Mechanics, 3.19): on the surface u_z = F (1 - nu^2)/(pi E r),
// u_r = F (1 + nu)(1 - 2 nu)/(2 pi E r) towards the force. The force is spread over a square of
// side 2 b = 1 (second order in b/r); what the finite block adds far away is uniform, so
// differences between two distances are compared.
TEST(HalfSpace, PointForceIsBoussinesqs) {
  constexpr int kCells = 16, kLayers = 8;
  constexpr double kReach = 100, kGrowth = 5.5;  // sinh grading: edges from 0.5 to 45
  TetMesh mesh = test::block_mesh({2, 2, 1}, kCells, kCells, kLayers, 1);
  const auto graded = [&](double s) {
    return kReach * std::sinh(kGrowth * s) / std::sinh(kGrowth);
  };
  for (Vec3& p : mesh.nodes) p = {graded(p.x() - 1), graded(p.y() - 1), -graded(1 - p.z())};
  mesh = to_second_order(mesh);
  std::vector<Triangle> loaded;
  double area = 0;
  const double edge = graded(2.0 / kCells) * 1.001;
  for (const Triangle& f : mesh.faces) {
    bool inside = true;
    for (const int n : f)
      inside = inside && mesh.nodes[n].z() > -1e-9 &&
               mesh.nodes[n].head<2>().cwiseAbs().maxCoeff() < edge;
    if (!inside) continue;
    loaded.push_back(f);
    area += 0.5 *
            (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]).norm();
  }
  for (const double nu : {0.3, 0.49}) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t i = 0; i < handle.size(); ++i)
      if (mesh.fixed[i]) handle[i] = kHeldNode;
    BodyModel model{&mesh, {isotropic_law(1, nu)}};
    model.dilatation = Dilatation::kElement;
    NonlinearBody body(model, handle);
    body.set_load(pressure_load(mesh, loaded, 1 / area));
    ASSERT_TRUE(body.solve(Eigen::VectorXd()).ok());
    // Nodes on the x axis.
    const auto at = [&](int cell) {
      const double x = graded(2.0 * cell / kCells);
      std::size_t best = 0;
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        if ((mesh.nodes[i] - Vec3(x, 0, 0)).norm() < (mesh.nodes[best] - Vec3(x, 0, 0)).norm())
          best = i;
      return std::pair<double, Vec3>(x,
                                     body.field().segment<3>(3 * static_cast<Eigen::Index>(best)));
    };
    const auto [r1, u1] = at(3);
    const auto [r2, u2] = at(4);
    const double inverse = 1 / r1 - 1 / r2;
    const double vertical = (1 - nu * nu) / M_PI * inverse;
    const double radial = (1 + nu) * (1 - 2 * nu) / (2 * M_PI) * inverse;
    std::printf("Boussinesq nu %.2f, r %.2f to %.2f: vertical %.4f, radial %.4f of the exact\n", nu,
                r1, r2, (u2 - u1).z() / vertical, (u2 - u1).x() / radial);
    EXPECT_NEAR((u2 - u1).z() / vertical, 1, 0.03);
    // Small beside the vertical one, and judged by it.
    EXPECT_NEAR((u2 - u1).x(), radial, 0.03 * vertical);
  }
}

}  // namespace
}  // namespace hapsim
