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
struct GainBlock {
  int position = 0;
  std::vector<Eigen::Index> rows;  // of the stacked vectors (3 x rows)
  Eigen::MatrixXd Z;               // the same rows x 6 [N]
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
