// Bounded nonlinear least squares by Gauss-Newton with QR, Levenberg damping and backtracking.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace hapsim {

// One unknown. `scale` is the size of a typical change; `logarithmic` unknowns are stepped in their
// logarithm (and must have positive bounds), those with a `log_limit` in log(limit - x) (and must
// have their upper bound below it).
struct Unknown {
  double value = 0;
  double lower = -1e300;
  double upper = 1e300;
  double scale = 1;
  bool logarithmic = false;
  double log_limit = std::numeric_limits<double>::quiet_NaN();
};

// Whitened residuals r (variance 1 each) and, when asked, their derivatives J = dr/dx (n x m).
using ResidualFunction =
    std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J)>;

// Told the least sum of squares so far, after each step; false ends the search with what there is.
using Watch = std::function<bool(double sum_of_squares)>;

struct LeastSquaresOptions {
  int max_iterations = 200;
  double step_tolerance = 1e-7;      // largest step in units of `scale` (or of the logarithm)
  double decrease_tolerance = 1e-3;  // decrease of the sum of squares over its mean per residual:
                                     // 1e-3 is 3 % of a standard error
  Watch watch;                       // may be empty
};

struct LeastSquaresResult {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;  // (J'J)^-1 of the unknowns that are not at a bound; zero rows else
  double sum_of_squares = 0;   // of the whitened residuals
  int iterations = 0;
  bool converged = false;
  bool stopped = false;  // by the watch
  std::string message;   // why it stopped
  std::vector<bool> at_bound;
  std::vector<bool> undetermined;  // directions that the data do not see go through this unknown
};

// Minimises |r|^2 within the bounds. Unknowns that the gradient pushes against their bound are held
// (active set); the step solves the damped problem by column-pivoted QR (Nocedal and Wright,
// Numerical Optimization, 10.3; the damping follows Marquardt, 1963).
LeastSquaresResult minimise(const std::vector<Unknown>& start, const ResidualFunction& residuals,
                            const LeastSquaresOptions& options = {});

}  // namespace hapsim
