// What else than a stiffness of each position may take what a model leaves, in as few numbers: a
// law of the force's direction and size that all positions share, or a gain of each press.
#pragma once

#include <Eigen/Core>

#include "diagnose/trial_ground.h"

namespace hapsim {

enum class Account { kPlaces, kOneLaw, kPresses };

// kOneLaw where a law that is the same at all positions takes nine tenths of `residual`, and as
// much as a stiffness of each position does (six gains each, experiment/weights.h; 0.96 of it:
// bodies that differ by place reach 0.94), by fewer numbers: then place has no part in it. The law:
// each axis of the recording answers to its own force by a curve of four straight pieces, and to
// each of the others by a straight and a square part; the force along the normal and across it go
// by curves of three straight pieces. kPresses where a gain of each press takes nine tenths, and
// 1.2 times what the positions do: then it is not the place that presses differ by. `forces`: of
// the model.
Account account_of(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                   const TrialGround& ground);

}  // namespace hapsim
