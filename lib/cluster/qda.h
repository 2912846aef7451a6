// Quadratic discriminant analysis with covariances that few samples can bear.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// How far a class's covariance is drawn to the pooled one, and that to a sphere of the same trace:
// 0 is plain QDA, pooled = 1 linear discriminant analysis (Friedman, J. Am. Statist. Assoc. 84,
// 1989).
struct QdaOptions {
  double pooled = 0;
  double sphere = 0;
};

class Qda {
 public:
  // Points n x d with labels 0 .. classes - 1, each class with at least one. Priors are the
  // classes' shares of the samples.
  Qda(const Eigen::MatrixXd& points, const std::vector<int>& label, int classes,
      const QdaOptions& options);
  // Some covariance is singular: more regularisation is needed.
  bool singular() const { return singular_; }
  // log(p(x | k) p(k)) with the normal density in d dimensions, thesis (5.16) put right.
  Eigen::VectorXd log_joint(const Eigen::VectorXd& x) const;
  // log p(k | x), thesis (5.14) with the sum over the classes.
  Eigen::VectorXd log_posterior(const Eigen::VectorXd& x) const;
  int classify(const Eigen::VectorXd& x) const;  // thesis (5.18)
  const QdaOptions& options() const { return options_; }

 private:
  struct Class {
    Eigen::VectorXd mean;
    Eigen::MatrixXd whitener;  // L^-1, covariance = L L'
    double constant = 0;       // log prior - log|L| - d/2 log 2 pi
  };
  std::vector<Class> classes_;
  QdaOptions options_;
  bool singular_ = false;
};

// The regularisation that puts the fewest samples on the wrong side, among equals the one whose log
// posterior of samples left out in turn is best, then the least.
Qda choose_qda(const Eigen::MatrixXd& points, const std::vector<int>& label, int classes);

}  // namespace hapsim
