// How much a residual counts: sensor noise, and the error of geometry and mesh at each position.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiment/forces.h"

namespace hapsim {

// Covariance by position V = noise^2 I + floor^2 Z Z'. Z has six columns: the symmetric relative
// changes of the position's stiffness, in the frame of its normal n and two tangents, as they act
// on the force: f_n n (a gain along the normal), three for the tangential plane, and n t' + t n'
// for both tangents (a tilted normal). So a model is not blamed for what a mesh and a scanned
// surface are worth: a stiffness that errs by a few per cent, differently at each position.
//
// Under a ball the contact grows, and what the body adds to a half-space grows with it: to first
// order in proportion to the contact's radius, which is the cube root of the force (Hertz, 1882;
// Dimitriadis et al., Biophys. J. 82, 2002). So a doubt of that bends the force over depth, by
// Dataset::curve_doubt at the largest force; what looks like it, or moves the first touch, is not
// blamed on the model either.
struct GainBlock {
  int position = 0;
  std::vector<Eigen::Index> rows;  // of the stacked vectors (3 x rows)
  Eigen::MatrixXd Z;               // the same rows x 6 [N]
  Eigen::VectorXd curve;           // one standard deviation of that bend [N]; empty: none
  // V = noise^2 I + D D': the columns of floor Z, and the bend.
  Eigen::MatrixXd deviations(double floor) const;
};
// One block for each position that the selection visits. `reference`: stacked forces.
std::vector<GainBlock> gain_directions(const Dataset& dataset, const Selection& selection,
                                       const Eigen::VectorXd& reference);

class Weights {
 public:
  // `reference`: stacked forces of a fitted model (they are fixed during a fit).
  Weights(const Dataset& dataset, const Selection& selection, const Eigen::VectorXd& reference,
          double noise, double floor);
  // V^(-1/2) applied to each column (stacked rows), in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> columns) const;

 private:
  struct Block {
    std::vector<Eigen::Index> rows;  // of the stacked vectors
    Eigen::MatrixXd Q;               // orthonormal directions of the gains
    Eigen::VectorXd shrink;          // what is taken from each direction
  };
  double noise_;
  std::vector<Block> blocks_;
};

}  // namespace hapsim
