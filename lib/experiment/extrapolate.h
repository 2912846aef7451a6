// A contact stiffness for a material near one that was solved, or that was not solved at all.
#pragma once

#include <utility>
#include <vector>

#include "contact/contact_library.h"
#include "effects/effect.h"

namespace hapsim {

// A Maxwell element with a matrix for its modulus.
struct MaxwellStiffness {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();  // [N/m]
  double tau = 1;                               // [s]
};

// K [N/m]; the body's force on the tool is -K u, less K_j h_j for each Maxwell element beside it,
// h_j its memory of u (material/maxwell_memory.h). The derivative by each free parameter of the
// material, by its column.
struct PositionStiffness {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  std::vector<std::pair<int, Eigen::Matrix3d>> by_column;
  std::vector<MaxwellStiffness> relaxing;  // of regions that relax each in its own way; no
                                           // derivatives
  void add(int column, const Eigen::Matrix3d& dK) {  // nothing where the parameter is not free
    if (column >= 0) by_column.emplace_back(column, dK);
  }
};

// About the reference: linear in the features' values and in the ratios of the moduli, exact in a
// common factor of the moduli; Poisson's ratio acts as on the homogeneous body, put right to first
// order.
PositionStiffness extrapolated(const StiffnessSolution& solution, const UnitStiffness& homogeneous,
                               const MaterialSpec& reference, const MaterialSpec& material);

// The stiffness with one more feature, K -> L G L' with L the Cholesky factor of K; `column` of
// each of the feature's values.
PositionStiffness with_estimate(const PositionStiffness& without,
                                const FeatureEstimate::Change& change,
                                const std::vector<int>& column);

}  // namespace hapsim
