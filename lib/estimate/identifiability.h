// What the data tell about the unknowns, and what they do not, in words.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimate/least_squares.h"

namespace hapsim {

// A combination of unknowns that the data see badly or not at all.
struct BlindDirection {
  Eigen::VectorXd direction;  // unit, in the unknowns' steps (value / scale, or logarithm)
  double error = 0;           // standard error along it, in those steps; infinite: not seen at all
  std::string sentence;       // "E and E1 enter only as their sum"
};

// Eigenvectors of the normal matrix J'J, its columns in the unknowns' steps, whose standard error
// (1 / singular value, times `noise` >= 1 where the misfit is larger than declared) exceeds
// `largest_error` steps: a factor e or a typical change by default. J is n x m of whitened
// residuals. Worst first (Belsley, Kuh and Welsch, Regression Diagnostics, 1980).
std::vector<BlindDirection> blind_directions(const std::vector<Unknown>& unknowns,
                                             const std::vector<std::string>& names,
                                             const Eigen::MatrixXd& J, double largest_error = 1,
                                             double noise = 1);

// Correlations of a covariance; 0 where a variance is 0.
Eigen::MatrixXd correlations(const Eigen::MatrixXd& covariance);

// Thesis (5.22): n_ref >= c n_parameters, with the c = 10 of its experiments.
bool enough_data(Eigen::Index references, Eigen::Index parameters, double ratio = 10);

}  // namespace hapsim
