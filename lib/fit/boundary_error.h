// What the uncertainty of a moved boundary adds to a fit with the boundary held.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cluster/class_boundary.h"
#include "fit/fit.h"

namespace hapsim {

// Adds to the standard errors of the free parameters D C D', where D = -(F'F)^-1 F' B says how the
// fitted values follow the boundary: F the derivatives of the forces by the free parameters that
// have a standard error, B = `by_shift` those by the shifts of its key points (stacked rows x
// shifts [N/m]), C = `covariance` of the shifts [m^2]. What is left of the fit's own error is not
// correlated with it: the shifts come from a fit together with the moduli.
void add_boundary_error(Fit& fitted, const Experiment& experiment, const Eigen::MatrixXd& by_shift,
                        const Eigen::MatrixXd& covariance);

// Gives the key points of `regions` their standard errors: that of the nearest point of the lines,
// across the boundary. `error` [m]: by point of the lines in turn, a closed line's end left out.
void tell_key_point_errors(Model& model, const std::vector<BoundaryLine>& lines,
                           const std::vector<double>& error);

}  // namespace hapsim
