// A homogeneous body's condensed stiffness at all Poisson's ratios of a range, from one
// factorisation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solid/affine_sweep.h"

namespace hapsim {

// The bilinear form of E = 1 is mu (B + kappa A): A the volumetric part, B the deviatoric one,
// kappa = lambda / mu.
class PoissonSweep {
 public:
  // `body` of `mesh`, of kElement and one handle, is factorised at the middle one of `nus`, at
  // which all is exact; the sweep is judged at the first and the last. Errors as
  // ElasticBody::factorise and AffineSweep.
  PoissonSweep(const TetMesh& mesh, ElasticBody& body, const std::vector<double>& nus);

  struct Solution {
    Eigen::Matrix3d K, dK_dnu;  // of E = 1 [m]
  };
  Solution at(double nu) const;
  // Displacements by the handle's unit displacements at the middle one.
  const AffineSweep::Fields& field() const { return field_; }
  std::size_t held_bytes() const {
    return sweep_.held_bytes() + sizeof(double) * static_cast<std::size_t>(field_.size());
  }

 private:
  double kappa_;  // where it was factorised
  AffineSweep::Fields field_;
  AffineSweep sweep_;
};

}  // namespace hapsim
