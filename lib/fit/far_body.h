// What is not known of a body beyond the contact, and what it does to a ball's forces.
#pragma once

#include "fit/fit.h"

namespace hapsim {

// The change of the stacked forces by one standard deviation of what the body adds to the
// compliance of the material under the tool (its thickness, its support, the law in series): 0.1 of
// that, and no more than half of the stiffness. Where the first touch is fitted too, E feels it
// several times over: both shape the curve. Empty where no ball is declared, or the body is as
// stiff as a half-space.
Eigen::VectorXd far_body_doubt(const Fit& fitted, const Experiment& experiment,
                               const Selection& selection, const Eigen::VectorXd& forces);

}  // namespace hapsim
