// What all positions may share of what a model leaves: a law of the force's direction and size.
#pragma once

#include <Eigen/Core>

#include "diagnose/trial_ground.h"

namespace hapsim {

// Whether a law that is the same at all positions takes nine tenths of `residual`, and as much as a
// stiffness of each position does (six gains each, experiment/weights.h; 0.98 of it), by fewer
// numbers: then place has no part in it. The law: each axis of the recording answers to the force
// along each, a straight part and a square one, and otherwise to either sign of its own; the force
// along the normal and across it go by a curve of four straight pieces. `forces`: of the model.
bool is_one_law(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                const TrialGround& ground);

}  // namespace hapsim
