// The exact end of one step of minimise_under(): private to lib/estimate.
#pragma once

#include <vector>

#include "estimate/step_problem.h"

namespace hapsim {

// Newton's method on the conditions of Karush, Kuhn and Tucker with what is taken to bind, to which
// is added what that breaks and from which is taken what it pulls at.
class StepActiveSet {
 public:
  // From p.y, with no bound held.
  StepActiveSet(StepProblem& p, std::vector<bool> binds);
  // Near p.y, the end of another method; `held`: -1: at the lower bound; 1: at the upper one.
  StepActiveSet(StepProblem& p, std::vector<bool> binds, Eigen::VectorXi held,
                Eigen::VectorXd factor);
  StepActiveSet(StepProblem& p, const IpoptEnd& end);

  // Sets the problem's y, and true, where it comes to a minimum that is no worse than `most`.
  bool run(double most);
  const std::vector<bool>& binds() const { return binds_; }

 private:
  bool solve();
  bool is_minimum() const;
  bool add_broken();
  bool release();
  bool is_equality(Eigen::Index c) const { return p_.most[c] == 0; }

  StepProblem& p_;
  std::vector<bool> binds_;
  Eigen::VectorXi held_;
  Eigen::VectorXd factor_, y_, of_bounds_;
  Eigen::MatrixXd curvature_, across_;
  std::vector<Eigen::Index> of_, bounds_;
};

}  // namespace hapsim
