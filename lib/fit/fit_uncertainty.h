// What a finished fit tells of its parameters: standard errors, intervals, and what is not seen.
#pragma once

#include <vector>

#include "estimate/least_squares.h"
#include "fit/fit.h"

namespace hapsim {

std::string parameter_label(const Parameter& p);  // "elastic E of region 2"

// The model's free parameters as a search takes them.
std::vector<Unknown> unknowns(const Model& model);

Eigen::VectorXd values_of(const std::vector<Unknown>& unknowns);
void set_unknowns(Model& model, const Eigen::VectorXd& x);  // the inverse: values only

// Covariance of the free parameters from (J'J)^-1 over the noise (`bread`): by the noise (or the
// misfit: `variance` over the noise's), the gain error of each position and the doubt of a ball's
// law; `shared`: what the parameters follow of what all positions err by.
Eigen::MatrixXd error_covariance(const Eigen::MatrixXd& bread, const Signal& signal,
                                 const Experiment& experiment, const Selection& selection,
                                 const FitOptions& options, double variance,
                                 const Eigen::VectorXd& shared);

// Of the covariance. Names what is at its bound and what the data cannot tell.
void set_standard_errors(Fit& result, const LeastSquaresResult& solution,
                         const Eigen::MatrixXd& covariance);

// Combinations of parameters that the data do not see; J: derivatives over the noise.
void tell_what_is_not_seen(Fit& result, const Eigen::MatrixXd& J, double noise);

// Intervals by the profile likelihood, in words.
void tell_intervals(Fit& result, const ResidualFunction& residuals,
                    const LeastSquaresResult& solution, double variance);

}  // namespace hapsim
