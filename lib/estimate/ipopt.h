// Ipopt, loaded when it is first asked for: most fits have no constraints between their unknowns,
// and its libraries take more memory than such a fit.
#pragma once

#include <Eigen/Core>
#include <string>

namespace hapsim {

// Least squares |r(y)|^2 under low <= y <= high and least <= A y <= most; what is beyond 1e19 does
// not bind.
class IpoptProblemOf {
 public:
  virtual ~IpoptProblemOf() = default;
  // Sets r and J = dr/dy.
  virtual void evaluate(const Eigen::VectorXd& y) = 0;

  Eigen::VectorXd y, low, high;  // y: the start, then the end
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> A;
  Eigen::VectorXd least, most;
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
};

struct IpoptEnd {
  bool began = false;  // else y is still the start
  bool converged = false;
  int iterations = 0;
  std::string message;
};

// With the Gauss-Newton matrix 2 J'J for the Hessian. One thread at a time. Error(kIo): Ipopt is
// not installed.
IpoptEnd minimise_by_ipopt(IpoptProblemOf& problem, int max_iterations);

}  // namespace hapsim
