// Least squares that a few bad readings cannot pull away.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimate/least_squares.h"

namespace hapsim {

// minimise(), or another of its kind.
using Minimiser = std::function<LeastSquaresResult(
    const std::vector<Unknown>&, const ResidualFunction&, const LeastSquaresOptions&)>;

enum class RobustLoss { kNone, kHuber, kTukey };
// "none", "huber" or "tukey".
RobustLoss robust_loss(const std::string& name);

// Weight of a residual of `size` standard deviations: 1 for small ones. Huber (Ann. Math. Statist.
// 35, 1964) with k = 1.345: k / |r| beyond; Tukey's biweight (Beaton and Tukey, Technometrics 16,
// 1974) with c = 4.685: (1 - (r/c)^2)^2, 0 beyond c. Both are 95 % efficient for normal errors.
double robust_weight(RobustLoss loss, double size);

struct RobustResult {
  LeastSquaresResult fit;   // sum_of_squares is the weighted one; covariance already times scale^2
  Eigen::VectorXd weights;  // one a residual, 0 .. 1
  double spread = 1;        // covariance over (J'J)^-1 of the unweighted problem
  double scale = 1;         // standard deviation of the good residuals, median(|r|) / 0.6745
  int rounds = 0;
  int discounted = 0;  // residuals with a weight below a half
};

// Iteratively reweighted least squares (Holland and Welsch, Commun. Statist. A6, 1977): whitened
// residuals are weighted by their size over `scale`, which is never below 1 (the declared noise),
// until the weights stay. Tukey starts from Huber's solution, for its loss has several valleys. The
// covariance is Huber's (1981, 7.6). Residuals must outnumber unknowns by half, else not converged.
// `minimiser`: of each weighted problem.
RobustResult minimise_robustly(const std::vector<Unknown>& start, const ResidualFunction& residuals,
                               RobustLoss loss, const LeastSquaresOptions& options = {},
                               const Minimiser& minimiser = minimise);

}  // namespace hapsim
