// How much a residual counts: sensor noise, and the error of geometry and mesh at each position.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/forces.h"

namespace hapsim {

// Covariance by position V = noise^2 I + floor^2 Z Z', Z two columns: the force along the
// position's normal and the force across it, as gains. So a model is not blamed for a gain of a few
// per cent that differs from position to position, which is what a mesh and a scanned surface are
// worth. The directions Z: for each position that the selection visits two columns, stacked rows (3
// x rows).
Eigen::MatrixXd gain_directions(const Dataset& dataset, const Selection& selection,
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
