// A body's condensed stiffness along a line of materials, from one factorisation.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "solid/elastic_body.h"

namespace hapsim {

// The bilinear form is A_0 + s A_1. All solutions lie in the Krylov space of A_0^-1 A_1 that the
// one at s = 0 starts, so Galerkin's method on a few of its vectors gives the stiffness at every s
// at which the form is positive, from above, with the square of the field's error (Grimme, Krylov
// projection methods for model reduction, 1997).
class AffineSweep {
 public:
  using Fields = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // 3 nodes x 3
  // `body`, of one handle, is factorised for A_0; `field` are its displacements by the handle's
  // unit displacements and `stiffness` their reaction. `part` of fields is A_1 times them. The
  // basis grows until the stiffness at all of `judged` (values of s) changes by less than 1e-6 of
  // itself; Poisson's ratio from 0.08 to 0.497 takes some nine steps, of which each leaves a fifth.
  // Directions that are rounding beside the rest are left out, and where none is left the solution
  // is exact. Error(kNoConvergence) where forty steps do not do.
  AffineSweep(const ElasticBody& body, const Eigen::Matrix3d& stiffness, const Fields& field,
              const std::function<Fields(const Fields&)>& part, const std::vector<double>& judged);

  struct Solution {
    Eigen::Matrix3d K, by_s;
  };
  Solution at(double s) const;
  std::size_t held_bytes() const {
    return sizeof(double) * static_cast<std::size_t>(coupling_.size() + basis_part_.size());
  }

 private:
  Eigen::Matrix3d stiffness_, part_;  // A_0 and A_1 of the fields at s = 0
  Fields coupling_;                   // A_1 between the basis and those
  Eigen::MatrixXd basis_part_;        // A_1 of the basis, whose A_0 is the identity
};

}  // namespace hapsim
