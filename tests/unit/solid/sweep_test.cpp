// One factorisation for a line of materials, against one for each.
#include <gtest/gtest.h>

#include <cmath>

#include "solid/elastic_assembly.h"
#include "solid/poisson_sweep.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

// A block held below, its upper face's middle moved.
struct Pressed {
  TetMesh mesh;
  ElasticBody body;
  explicit Pressed(int order)
      : mesh(test::block_mesh({0.06, 0.06, 0.02}, 6, 6, 3, order, 0.2)),
        body(mesh, handles(mesh), Dilatation::kElement) {}

  static std::vector<int> handles(const TetMesh& mesh) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t n = 0; n < handle.size(); ++n) {
      const Vec3& p = mesh.nodes[n];
      if (p.z() < 1e-9) handle[n] = kHeldNode;
      if (p.z() > 0.02 - 1e-9 && (p.head<2>() - Eigen::Vector2d(0.03, 0.03)).norm() < 0.011)
        handle[n] = 0;
    }
    return handle;
  }
  Eigen::Matrix3d solved(double nu) {
    body.factorise(std::vector<Lame>(mesh.tets.size(), lame(1, nu)));
    return body.solve(Eigen::Matrix3d::Identity()).reaction;
  }
};

TEST(PoissonSweep, IsTheSolutionAtEveryRatio) {
  for (const int order : {1, 2}) {
    Pressed pressed(order);
    const std::vector<double> nus{0.4969, 0.4108, 0.0828};
    const PoissonSweep sweep(pressed.mesh, pressed.body, nus);
    for (const double nu : {0.0828, 0.2, 0.35, 0.4108, 0.47, 0.49, 0.4969}) {
      const Eigen::Matrix3d K = sweep.at(nu).K, exact = pressed.solved(nu);
      EXPECT_LT((K - exact).norm(), (nu == 0.4108 ? 1e-11 : 5e-7) * exact.norm()) << nu;
      // Galerkin's stiffness is never below the solution's.
      EXPECT_GT((K - exact).trace(), -1e-11 * exact.trace()) << nu;
    }
    // Beyond the ends the basis was not judged; what follows from it stays smooth.
    EXPECT_LT((sweep.at(0).K - pressed.solved(0)).norm(), 1e-5 * pressed.solved(0).norm());
  }
}

TEST(PoissonSweep, DerivativeIsThatOfFiniteDifferences) {
  Pressed pressed(2);
  const PoissonSweep sweep(pressed.mesh, pressed.body, {0.49, 0.4, 0.1});
  const double h = 1e-6;
  for (const double nu : {0.1, 0.3, 0.4, 0.49}) {
    const Eigen::Matrix3d by_nu = (sweep.at(nu + h).K - sweep.at(nu - h).K) / (2 * h);
    EXPECT_LT((sweep.at(nu).dK_dnu - by_nu).norm(), 1e-7 * by_nu.norm()) << nu;
  }
}

TEST(PoissonSweep, OfOneRatioIsItsSolution) {
  Pressed pressed(2);
  const PoissonSweep sweep(pressed.mesh, pressed.body, {0.45});
  const Eigen::Matrix3d exact = pressed.solved(0.45);
  EXPECT_LT((sweep.at(0.45).K - exact).norm(), 1e-12 * exact.norm());
}

// A ball of other moduli inside: A_1 may be negative as far as the whole stays positive.
TEST(AffineSweep, IsTheSolutionWithAStifferOrSofterInside) {
  Pressed pressed(2);
  const TetMesh& mesh = pressed.mesh;
  std::vector<char> inside(mesh.tets.size(), 0);
  for (std::size_t t = 0; t < inside.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) middle += mesh.nodes[mesh.tets[t][k]] / 4;
    inside[t] = (middle - Vec3(0.03, 0.03, 0.01)).norm() < 0.009 ? 1 : 0;
  }
  const Lame unit = lame(1, 0.45);
  const auto solved = [&](double ratio) -> Eigen::Matrix3d {
    std::vector<Lame> constants;
    for (const char in : inside)
      constants.push_back(in ? Lame{ratio * unit.lambda, ratio * unit.mu} : unit);
    pressed.body.factorise(constants);
    return pressed.body.solve(Eigen::Matrix3d::Identity()).reaction;
  };
  const std::vector<double> ratios{0.05, 0.4, 3, 15};
  std::vector<Eigen::Matrix3d> exact;
  for (const double ratio : ratios) exact.push_back(solved(ratio));
  const Eigen::Matrix3d bare = solved(1);
  const AffineSweep::Fields field = pressed.body.solve(Eigen::Matrix3d::Identity()).field;
  const AffineSweep sweep(
      pressed.body, bare, field,
      [&](const AffineSweep::Fields& fields) {
        AffineSweep::Fields forces = AffineSweep::Fields::Zero(fields.rows(), 3);
        for (std::size_t t = 0; t < inside.size(); ++t) {
          if (!inside[t]) continue;
          const Eigen::MatrixXd k = element_matrix(mesh, t, unit, Dilatation::kElement);
          for (int a = 0; a < 10; ++a)
            for (int b = 0; b < 10; ++b)
              forces.middleRows<3>(3 * mesh.tets[t][a]) +=
                  k.block<3, 3>(3 * a, 3 * b) * fields.middleRows<3>(3 * mesh.tets[t][b]);
        }
        return forces;
      },
      {-0.95, -0.6, 2, 14});
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    EXPECT_GT((exact[k] - bare).norm(), 1e-2 * bare.norm());
    EXPECT_LT((sweep.at(ratios[k] - 1).K - exact[k]).norm(), 1e-6 * exact[k].norm()) << ratios[k];
  }
}

// A_1 of one spring between points inside: its space ends at once, in two of three columns before
// that; K = K_0 + s g g'/(1 + s v'A_0^-1 v), g the spring's length by the handle (Sherman and
// Morrison, Ann. Math. Stat. 21, 1950).
TEST(AffineSweep, OfOneSpringIsShermanAndMorrisons) {
  Pressed pressed(1);
  const TetMesh& mesh = pressed.mesh;
  pressed.body.factorise(std::vector<Lame>(mesh.tets.size(), lame(1, 0.4)));
  const ElasticBody::Response without = pressed.body.solve(Eigen::Matrix3d::Identity());
  Eigen::VectorXd spring = Eigen::VectorXd::Zero(without.field.rows());
  const std::vector<int> handle = Pressed::handles(mesh);
  int ends = 0;
  for (std::size_t n = mesh.nodes.size() / 2; n < mesh.nodes.size() && ends < 2; ++n)
    if (handle[n] == kFreeNode)
      spring.segment<3>(3 * static_cast<Eigen::Index>(n)) = ++ends * Vec3(1, -0.5, 2);
  ASSERT_EQ(ends, 2);
  AffineSweep::Fields alone = AffineSweep::Fields::Zero(spring.size(), 3);
  alone.col(1) = spring;
  const double give = spring.dot(pressed.body.relax(alone).col(1));
  const Vec3 g = without.field.transpose() * spring;
  const AffineSweep sweep(pressed.body, without.reaction, without.field,
                          [&](const AffineSweep::Fields& fields) -> AffineSweep::Fields {
                            return spring * (spring.transpose() * fields);
                          },
                          {0.1, 10});
  for (const double s : {0.01, 0.1, 1.0, 10.0}) {
    const Eigen::Matrix3d exact = without.reaction + s / (1 + s * give) * g * g.transpose();
    EXPECT_LT((sweep.at(s).K - exact).norm(), 1e-11 * exact.norm()) << s;
  }
}

}  // namespace
}  // namespace hapsim
