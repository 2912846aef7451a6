// Data left out of a regularised field, group by group, in closed form: private to lib/estimate.
#pragma once

#include <Eigen/Core>

#include "estimate/regularised.h"

namespace hapsim {

struct GroupsLeftOut {
  double error = 0;      // root mean square, in the data's errors
  double log_score = 0;  // log density, but for a constant
};

// From `hat`, the derivative of the predicted by the data, and what these leave: (I - H_gg)^-1 of
// the residuals of a group, and of its covariance.
GroupsLeftOut left_out(const FieldProblem& problem, const Eigen::MatrixXd& hat,
                       const Eigen::VectorXd& residual);

}  // namespace hapsim
