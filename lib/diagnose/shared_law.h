// What all positions may share of what a model leaves: a law of the force's direction and size.
#pragma once

#include <Eigen/Core>

#include "diagnose/trial_ground.h"

namespace hapsim {

// Whether a law that is the same at all positions takes nine tenths of `residual`, and as much as a
// stiffness of each position does (six gains each, experiment/weights.h; 0.96 of it: bodies that
// differ by place reach 0.94), by fewer numbers: then place has no part in it. The law: each axis
// of the recording answers to its own force by a curve of four straight pieces, and to each of the
// others by a straight and a square part; the force along the normal and across it go by curves of
// three straight pieces. `forces`: of the model.
bool is_one_law(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                const TrialGround& ground);

}  // namespace hapsim
