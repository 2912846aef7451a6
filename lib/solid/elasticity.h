// Isotropic linear elasticity on tetrahedra of first and second order.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/vec3.h"
#include "mesh/tetmesh.h"
#include "solid/dilatation.h"

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
// One point for 4 nodes; four for 10 nodes with every middle at the middle of its edge (exact to
// second degree, all that is needed there); else isoparametric with 14 points (degree 5).
// Error(kBadInput) where a curved element folds over (its number, its first corner).
struct ElementGradients {
  int nodes = 0;
  int points = 0;
  std::array<double, 14> weight;
  std::array<Eigen::Matrix<double, 3, 10>, 14> gradient;  // gradient[q].col(a) = grad N_a [1/m]
};
ElementGradients element_gradients(const TetMesh& mesh, std::size_t tet);

// The 3x3 block between nodes a and b of an element's stiffness [N/m]. With G the integral of
// grad N_a (x) grad N_b [m]: lambda G + mu (G' + tr(G) I) (Zienkiewicz and Taylor, The Finite
// Element Method, vol. 1); with kElement the first term takes the mean gradients instead,
// lambda V g_a g_b'.
class ElementStiffness {
 public:
  ElementStiffness(const TetMesh& mesh, std::size_t tet, const Lame& constants,
                   Dilatation dilatation);
  Eigen::Matrix3d block(int a, int b) const;

 private:
  ElementGradients element_;
  Lame constants_;
  bool averaged_;
  double volume_ = 0;
  Eigen::Matrix<double, 3, 10> mean_;
};

// For displacement fields u_1..u_m (columns, 3 x nodes unknowns), the element's
// volumetric(i,j) = integral of div u_i div u_j and deviatoric(i,j) = integral of 2 eps_i : eps_j,
// so that the bilinear form is lambda * volumetric + mu * deviatoric, with [m^3] for fields in m.
// With kElement, div u is its mean over the element.
struct ElementEnergies {
  Eigen::Matrix3d volumetric;
  Eigen::Matrix3d deviatoric;
};
ElementEnergies element_energies(const TetMesh& mesh, std::size_t tet,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields,
                                 Dilatation dilatation = Dilatation::kPointwise);

}  // namespace hapsim
