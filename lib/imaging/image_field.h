// The smoothest or most piecewise constant field of moduli that all presses together ask for.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/field_stiffness.h"
#include "estimate/regularised.h"

namespace hapsim {

struct ImageField {
  FieldGrid grid;             // twice as coarse as that of the sensitivities
  Eigen::VectorXd log_ratio;  // log of the modulus over the model's, at the grid's nodes
  // What the presses leave open of these, and over which length [m] each is an average
  // (estimate/field_posterior.h).
  Eigen::VectorXd std_error, resolution;
  double weight = 0;    // of the penalty
  double misfit = 0;    // root mean square of the log gains that the field leaves
  double held_out = 0;  // the same for positions left out
};

// `J` views x nodes of `fine`, the log gains `data` with their standard errors, and the position of
// each (`group`). Regularised by solve_field(), its penalty drawn down with the sensitivity so that
// depth is not punished.
ImageField image_field(const Eigen::MatrixXd& J, const FieldGrid& fine,
                       const std::vector<int>& group, const Eigen::VectorXd& data,
                       const Eigen::VectorXd& error, Penalty penalty, int threads = 0);

}  // namespace hapsim
