// What the data leave open of a field that was found by regularisation, and what it can resolve.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/vec3.h"
#include "estimate/regularised.h"

namespace hapsim {

struct FieldPosterior {
  Eigen::VectorXd std_error;   // of each unknown about the chosen field
  Eigen::VectorXd resolution;  // length in the unit of the places, see below
};

// The penalty taken for the logarithm of a prior, p(m) ~ exp(-weight/2 penalty(m)), and the data's
// errors for normal ones, the posterior is near a normal distribution with the covariance
//   C = (J'J + weight R)^-1 = P - P J' (I + J P J')^-1 J P,  P = (weight R)^-1,
// exactly for the smooth penalty. Of total variation R = sum of q (edge_weight D)^2 has the factors
//   q = kEdge / sqrt(E t^2 + kEdge^2),  E t^2 = (mean jump)^2 + its variance under C,
// to their fixed point (Babacan, Molina and Katsaggelos, IEEE Trans. Image Processing 17, 2008):
// the curvature at the field itself would take every flat part for sure. The entries of P are
// exact. The weight is not known either: the variance is
//   sum over weights of share (C_ii + (mean_i - chosen_i)^2),
// shares by the density of the data left out group by group (Geisser and Eddy, J. Am. Statist.
// Assoc. 74, 1979). Data that show no contrast choose a weight under which there is none anywhere,
// also where they do not reach; so no weight counts under which the prior's standard deviation of
// the middle unknown is below problem.least_spread, and the one where it is that stands for those
// beyond.
// Of resolution: the mean is the averages M m of the true field, M = C J'J of the likeliest weight
// (Backus and Gilbert, Geophys. J. R. astr. Soc. 16, 1968); the length is the root mean square
// distance from an unknown's own place of what its value is taken from,
//   (sum_j M_ij^2 |x_j - x_i|^2 / sum_j M_ij^2)^1/2;
// infinite where no datum reaches. `place`: of each unknown. The weights by `threads` threads.
FieldPosterior field_posterior(const FieldProblem& problem, const FieldSolution& solution,
                               Penalty penalty, const std::vector<Vec3>& place, int threads = 0);

}  // namespace hapsim
