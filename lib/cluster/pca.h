// Principal components: the directions in which samples vary most.
#pragma once

#include <Eigen/Core>

namespace hapsim {

struct PrincipalComponents {
  Eigen::VectorXd mean;      // d
  Eigen::MatrixXd axes;      // d x d, one unit axis a column, the largest variance first; the
                             // largest entry of each is positive
  Eigen::VectorXd variance;  // along the axes, n - 1 in the denominator
};

// Thesis (5.3) of the covariance of samples, n x d with n > 1 (Jolliffe, Principal Component
// Analysis, 2002).
PrincipalComponents principal_components(const Eigen::MatrixXd& samples);

// Coordinates along the first `count` axes, n x count, thesis (5.5).
Eigen::MatrixXd project(const PrincipalComponents& components, const Eigen::MatrixXd& samples,
                        Eigen::Index count);

// Standard errors of those coordinates when the samples' columns have independent errors (n x d).
Eigen::MatrixXd project_errors(const PrincipalComponents& components, const Eigen::MatrixXd& errors,
                               Eigen::Index count);

}  // namespace hapsim
