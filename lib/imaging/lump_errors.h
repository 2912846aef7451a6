// Log gains made independent of each other, and of what no ball can be told from.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "imaging/lump_fit.h"

namespace hapsim {

class LumpErrors {
 public:
  // `common`: standard deviation that the views of a position share; `slopes` (views x 2): what a
  // metre that a contact point lies off does to them; may be empty.
  LumpErrors(const LumpData& data, double common, const Eigen::MatrixXd& slopes);
  // Over their standard errors, the free directions taken out.
  Eigen::VectorXd white(const Eigen::VectorXd& signal) const;
  double chi2(const Eigen::VectorXd& signal) const { return white(signal).squaredNorm(); }
  Eigen::Index freedom() const { return standard_.size() - free_.cols(); }
  const Eigen::VectorXd& standard() const { return standard_; }  // errors of the views

 private:
  std::vector<Eigen::MatrixXd> inverse_;  // of the Cholesky factor, by position
  std::vector<Eigen::Index> first_;       // view of each position, and their count
  Eigen::MatrixXd free_;                  // orthonormal
  Eigen::VectorXd standard_;
};

}  // namespace hapsim
