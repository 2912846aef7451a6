// Isotropic linear elasticity on straight-sided tetrahedra of first and second order.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/vec3.h"
#include "geometry/tetmesh.h"

namespace hapsim {

// Lame's constants [Pa]: lambda = E nu / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)).
struct Lame {
  double lambda = 0;
  double mu = 0;
};
Lame lame(double youngs_modulus, double poisson_ratio);
// Their derivatives by Poisson's ratio.
Lame lame_by_poisson(double youngs_modulus, double poisson_ratio);

// Shape function gradients at the quadrature points of one tetrahedron; weights sum to its volume.
// One point for 4 nodes, four (exact to second degree, all that straight sides need) for 10 nodes.
struct ElementGradients {
  int nodes = 0;
  int points = 0;
  std::array<double, 4> weight{};
  std::array<Eigen::Matrix<double, 3, 10>, 4> gradient;  // gradient[q].col(a) = grad N_a [1/m]
};
ElementGradients element_gradients(const TetMesh& mesh, std::size_t tet);

// Integral of grad N_a (x) grad N_b over the element [m]: the 3x3 block from which both stiffnesses
// follow, lambda G + mu (G' + tr(G) I) (Zienkiewicz and Taylor, The Finite Element Method, vol. 1).
Eigen::Matrix3d gradient_product(const ElementGradients& element, int a, int b);

// For displacement fields u_1..u_m (columns, 3 x nodes unknowns), the element's
// volumetric(i,j) = integral of div u_i div u_j and deviatoric(i,j) = integral of 2 eps_i : eps_j,
// so that the bilinear form is lambda * volumetric + mu * deviatoric, with [m^3] for fields in m.
struct ElementEnergies {
  Eigen::Matrix3d volumetric;
  Eigen::Matrix3d deviatoric;
};
ElementEnergies element_energies(const TetMesh& mesh, std::size_t tet,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields);

}  // namespace hapsim
