#include "solid/elasticity.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.h"

namespace hapsim {
namespace {

// Fourteen points of degree 5, all weights positive (Walkington, 2000): orbits (a, a, a, 1 - 3 a)
// twice and (a, a, 1/2 - a, 1/2 - a); weights sum to one.
struct Quadrature14 {
  std::array<std::array<double, 4>, 14> point;  // barycentric
  std::array<double, 14> weight;
};

Quadrature14 quadrature14() {
  Quadrature14 rule;
  int q = 0;
  const auto corner_orbit = [&](double a, double w) {
    for (int k = 0; k < 4; ++k, ++q) {
      rule.point[q].fill(a);
      rule.point[q][k] = 1 - 3 * a;
      rule.weight[q] = w;
    }
  };
  corner_orbit(0.3108859192633006, 0.1126879257180159);
  corner_orbit(0.0927352503108912, 0.0734930431163619);
  for (const auto& edge : kTetEdges) {
    constexpr double kA = 0.0455037041256497;
    rule.point[q].fill(kA);
    rule.point[q][edge[0]] = rule.point[q][edge[1]] = 0.5 - kA;
    rule.weight[q++] = 0.0425460207770815;
  }
  return rule;
}

bool is_straight(const TetMesh& mesh, const std::array<int, 10>& n) {
  for (int e = 0; e < 6; ++e) {
    const Vec3& a = mesh.nodes[n[kTetEdges[e][0]]];
    const Vec3& b = mesh.nodes[n[kTetEdges[e][1]]];
    if ((mesh.nodes[n[4 + e]] - 0.5 * (a + b)).squaredNorm() > 1e-20 * (a - b).squaredNorm())
      return false;
  }
  return true;
}

// Isoparametric: x = sum N_a x_a, in the local coordinates l_1, l_2, l_3 (l_0 = 1 - their sum).
ElementGradients curved_gradients(const TetMesh& mesh, std::size_t tet) {
  static const Quadrature14 rule = quadrature14();
  const auto& n = mesh.tets[tet];
  ElementGradients element;
  element.nodes = 10;
  element.points = 14;
  for (int q = 0; q < element.points; ++q) {
    const auto& l = rule.point[q];
    Eigen::Matrix<double, 4, 10> by_l = Eigen::Matrix<double, 4, 10>::Zero();  // dN_a / dl_k
    for (int a = 0; a < 4; ++a) by_l(a, a) = 4 * l[a] - 1;
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      by_l(i, 4 + e) = 4 * l[j];
      by_l(j, 4 + e) = 4 * l[i];
    }
    const Eigen::Matrix<double, 3, 10> local = by_l.bottomRows<3>().rowwise() - by_l.row(0);
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();  // dx_r / dl_k
    for (int a = 0; a < 10; ++a) jacobian.noalias() += mesh.nodes[n[a]] * local.col(a).transpose();
    const double determinant = jacobian.determinant();
    if (!(determinant > 0)) {
      const Vec3& x = mesh.nodes[n[0]];
      fail_input("",
                 fmt::format("the curved tetrahedron {} at ({:.6g}, {:.6g}, {:.6g}) folds over",
                             tet, x.x(), x.y(), x.z()),
                 "use straight edges, or mesh the body again with hs-tetmesh");
    }
    element.weight[q] = rule.weight[q] * determinant / 6;
    element.gradient[q] = jacobian.inverse().transpose() * local;
  }
  return element;
}

}  // namespace

Lame lame(double youngs_modulus, double poisson_ratio) {
  const double e = youngs_modulus, nu = poisson_ratio;
  return {e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))};
}

Lame lame_by_poisson(double youngs_modulus, double poisson_ratio) {
  const double e = youngs_modulus, nu = poisson_ratio;
  const double denominator = (1 + nu) * (1 - 2 * nu);
  return {e * (1 + 2 * nu * nu) / (denominator * denominator), -e / (2 * (1 + nu) * (1 + nu))};
}

ElementGradients element_gradients(const TetMesh& mesh, std::size_t tet) {
  const auto& n = mesh.tets[tet];
  if (mesh.order == 2 && !is_straight(mesh, n)) return curved_gradients(mesh, tet);
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = mesh.nodes[n[k + 1]] - mesh.nodes[n[0]];
  const double volume = edges.determinant() / 6;
  // Barycentric gradients: rows of the inverse, and minus their sum for corner 0.
  const Eigen::Matrix3d inverse = edges.inverse();
  Eigen::Matrix<double, 3, 4> bary;
  bary.rightCols<3>() = inverse.transpose();
  bary.col(0) = -inverse.transpose().rowwise().sum();

  ElementGradients element;
  if (mesh.order == 1) {
    element.nodes = 4;
    element.points = 1;
    element.weight[0] = volume;
    element.gradient[0].leftCols<4>() = bary;
    return element;
  }
  constexpr double kNear = 0.5854101966249685, kFar = 0.1381966011250105;
  element.nodes = 10;
  element.points = 4;
  for (int q = 0; q < 4; ++q) {
    element.weight[q] = volume / 4;
    std::array<double, 4> l{kFar, kFar, kFar, kFar};
    l[q] = kNear;
    for (int a = 0; a < 4; ++a) element.gradient[q].col(a) = (4 * l[a] - 1) * bary.col(a);
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      element.gradient[q].col(4 + e) = 4 * (l[i] * bary.col(j) + l[j] * bary.col(i));
    }
  }
  return element;
}

ElementStiffness::ElementStiffness(const TetMesh& mesh, std::size_t tet, const Lame& constants,
                                   Dilatation dilatation)
    : element_(element_gradients(mesh, tet)),
      constants_(constants),
      averaged_(dilatation != Dilatation::kPointwise && element_.points > 1) {
  if (!averaged_) return;
  mean_.setZero();
  for (int q = 0; q < element_.points; ++q) {
    volume_ += element_.weight[q];
    mean_ += element_.weight[q] * element_.gradient[q];
  }
  mean_ /= volume_;
}

Eigen::Matrix3d ElementStiffness::block(int a, int b) const {
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  for (int q = 0; q < element_.points; ++q)
    g.noalias() +=
        element_.weight[q] * element_.gradient[q].col(a) * element_.gradient[q].col(b).transpose();
  Eigen::Matrix3d k = constants_.mu * g.transpose();
  k.diagonal().array() += constants_.mu * g.trace();
  if (averaged_)
    k.noalias() += constants_.lambda * volume_ * mean_.col(a) * mean_.col(b).transpose();
  else
    k += constants_.lambda * g;
  return k;
}

ElementEnergies element_energies(const TetMesh& mesh, std::size_t tet,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields,
                                 Dilatation dilatation) {
  const ElementGradients element = element_gradients(mesh, tet);
  ElementEnergies energies{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  Eigen::Vector3d dilated = Eigen::Vector3d::Zero();  // integral of div u_i
  double volume = 0;
  for (int q = 0; q < element.points; ++q) {
    const double w = element.weight[q];
    std::array<Eigen::Matrix3d, 3> strain;
    Eigen::Vector3d divergence;
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  // d u_r / d x_c
      for (int a = 0; a < element.nodes; ++a)
        gradient.noalias() +=
            fields.block<3, 1>(3 * mesh.tets[tet][a], i) * element.gradient[q].col(a).transpose();
      strain[i] = 0.5 * (gradient + gradient.transpose());
      divergence[i] = gradient.trace();
    }
    energies.volumetric += w * divergence * divergence.transpose();
    dilated += w * divergence;
    volume += w;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        energies.deviatoric(i, j) += w * 2 * strain[i].cwiseProduct(strain[j]).sum();
  }
  if (dilatation != Dilatation::kPointwise)
    energies.volumetric = dilated * dilated.transpose() / volume;
  return energies;
}

}  // namespace hapsim
