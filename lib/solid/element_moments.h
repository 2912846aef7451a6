// Second-order elements of any linear law: stiffness, and what the energy of unit fields needs.
#pragma once

#include <Eigen/Core>

#include "material/material_law.h"
#include "solid/elasticity.h"

namespace hapsim {

// 3x3 blocks of an element's stiffness from the integrals of grad N_a (x) grad N_b.
class BlockMaker {
 public:
  explicit BlockMaker(const VoigtMatrix& D);
  Eigen::Matrix3d operator()(const Eigen::Matrix3d& g) const;

 private:
  Eigen::Matrix3d by_gradients_[3][3];  // D_ikjl
};

// The stiffness for stress = scale (D strain + kappa mean(tr strain) 1) [N/m].
void element_matrix(const ElementGradients& element, const BlockMaker& block, double kappa,
                    double scale, Eigen::Matrix<double, 30, 30>& K);

// Sums over elements of what any law's energy needs of the three unit fields i, j:
// strain(i, j) = integral of eps_i eps_j', volume(i, j) = integral of mean div u_i div u_j.
struct FieldMoments {
  VoigtMatrix strain[3][3];
  Eigen::Matrix3d volume = Eigen::Matrix3d::Zero();
  FieldMoments();
  FieldMoments(const ElementGradients& element, const Eigen::Matrix<double, 30, 3>& fields);
  void add(double weight, const FieldMoments& other);
  Eigen::Matrix3d energy(const VoigtMatrix& D, double kappa) const;  // symmetric
};

}  // namespace hapsim
