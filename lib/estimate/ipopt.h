// Ipopt, loaded when it is first asked for: most fits have no constraints between their unknowns,
// and its libraries take more memory than such a fit.
#pragma once

#include <Eigen/Core>
#include <string>

namespace hapsim {

// Least squares |r(y)|^2 under low <= y <= high and least <= g(y) <= most; what is beyond 1e19 does
// not bind. g is A y, or what constrain() makes of it.
class IpoptProblemOf {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  virtual ~IpoptProblemOf() = default;
  // Sets r and J = dr/dy.
  virtual void evaluate(const Eigen::VectorXd& y) = 0;
  // Of a g that is not linear curves() is true, constrain() sets A = dg/dy too, and bend() adds the
  // sum of factor_c g_c'' to H.
  virtual bool curves() const { return false; }
  virtual void constrain(const Eigen::VectorXd& at) {
    g.resize(A.rows());
    for (Eigen::Index c = 0; c < A.rows(); ++c) g[c] = A.row(c).dot(at);
  }
  virtual void bend(const Eigen::VectorXd&, const Eigen::VectorXd& /*factor*/,
                    Eigen::MatrixXd& /*H*/) {}

  Eigen::VectorXd y, low, high;  // y: the start, then the end
  Eigen::VectorXd g;
  Rows A;
  Eigen::VectorXd least, most;
  Eigen::VectorXd r;
  Eigen::MatrixXd J;
};

struct IpoptEnd {
  bool began = false;  // else y is still the start
  bool converged = false;
  int iterations = 0;
  std::string message;
  Eigen::VectorXd of_constraints, of_low, of_high;  // multipliers at the end
};

// With the Gauss-Newton matrix 2 J'J for the Hessian, and the exact one of the constraints. One
// thread at a time. Error(kIo): Ipopt is not installed.
IpoptEnd minimise_by_ipopt(IpoptProblemOf& problem, int max_iterations);

}  // namespace hapsim
