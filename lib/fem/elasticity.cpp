#include "fem/elasticity.h"

#include <Eigen/Dense>

namespace hapsim {

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
  constexpr std::array<std::array<int, 2>, 6> kEdges{
      {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  element.nodes = 10;
  element.points = 4;
  for (int q = 0; q < 4; ++q) {
    element.weight[q] = volume / 4;
    std::array<double, 4> l{kFar, kFar, kFar, kFar};
    l[q] = kNear;
    for (int a = 0; a < 4; ++a) element.gradient[q].col(a) = (4 * l[a] - 1) * bary.col(a);
    for (int e = 0; e < 6; ++e) {
      const auto [i, j] = kEdges[e];
      element.gradient[q].col(4 + e) = 4 * (l[i] * bary.col(j) + l[j] * bary.col(i));
    }
  }
  return element;
}

Eigen::Matrix3d gradient_product(const ElementGradients& element, int a, int b) {
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  for (int q = 0; q < element.points; ++q)
    product.noalias() +=
        element.weight[q] * element.gradient[q].col(a) * element.gradient[q].col(b).transpose();
  return product;
}

ElementEnergies element_energies(const TetMesh& mesh, std::size_t tet,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields) {
  const ElementGradients element = element_gradients(mesh, tet);
  ElementEnergies energies{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (int q = 0; q < element.points; ++q) {
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
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        energies.volumetric(i, j) += element.weight[q] * divergence[i] * divergence[j];
        energies.deviatoric(i, j) +=
            element.weight[q] * 2 * strain[i].cwiseProduct(strain[j]).sum();
      }
  }
  return energies;
}

}  // namespace hapsim
