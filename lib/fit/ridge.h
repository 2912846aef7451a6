// Along which values of a hardly known size the others make up for it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fit/fit.h"

namespace hapsim {

inline constexpr double kRise95 = 3.841458821;  // of chi squared with one degree of freedom

// The profile of the likelihood of one free parameter, all others fitted beside it and the bodies
// solved anew at every step: where the least sum of squares over all others has risen by a
// threshold (Venzon and Moolgavkar, Appl. Statist. 37, 1988). That is 3.84 of the variance that
// the parameter has over the one it would have by noise alone, since the gains of places are no
// noise (Kent, Biometrika 69, 1982).
struct Ridge {
  Eigen::Index which = 0;    // of the free parameters
  double low = 0, high = 0;  // where it has risen so far; the bound where it is open
  bool open_low = false, open_high = false;
  std::vector<Eigen::VectorXd> along;  // all free parameters within these ends, in no order
};

// A parameter may have one: finite elements are solved for it, and it is stepped in its logarithm.
bool may_have_ridge(const Parameter& p);
bool has_ridges(const Model& model);  // a free one may

// Standard errors of all that moves along it: of its own parameter the longer side in logarithms
// (no less than it had), of the others their way along it and what they are uncertain by beside it.
// `covariance` of the free parameters, by which (and `bread`, what it would be by noise alone) the
// latter is taken. Names it undetermined where both of its ends are open, and tells in words what
// trades.
void set_ridge_errors(Fit& fitted, const Ridge& ridge, const Eigen::MatrixXd& bread,
                      const Eigen::MatrixXd& covariance);

}  // namespace hapsim
