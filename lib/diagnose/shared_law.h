// A law of the force's direction and size that all positions share.
#pragma once

#include <Eigen/Core>

#include "experiment/dataset.h"

namespace hapsim {

// What such a law may do to the model's `forces`, a column each of its 36 numbers (both stacked
// [N]): each axis of the recording answers to its own force by a curve of four straight pieces, and
// to each of the others by a straight part, a square one and one of its size alone; the force along
// the normal and across it go by curves of three straight pieces.
Eigen::MatrixXd law_columns(const Eigen::VectorXd& forces, const Dataset& dataset);

}  // namespace hapsim
