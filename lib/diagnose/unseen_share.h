// How much of a residual a linear law foretells on presses that it was not fitted to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/trial_ground.h"

namespace hapsim {

// Presses in three parts, so that each holds one of each position that was pressed three times or
// more; the part of each sample, in the order of all_episodes().
std::vector<int> press_parts(const Dataset& dataset);

// Squares [N^2] of what is left of each sample of `residual` (three components a sample) where each
// part of `parts` is foretold by `columns`, fitted to the others by least squares: cross-validation
// (Stone, J. Roy. Stat. Soc. B 36, 1974). A ridge (Hoerl & Kennard, Technometrics 12, 1970) keeps
// small what the others hardly tell; of several the one that foretells best. May be more than the
// residual's own.
Eigen::VectorXd unforetold_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                                   const std::vector<int>& parts);

}  // namespace hapsim
