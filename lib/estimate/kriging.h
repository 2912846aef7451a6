// Interpolation between scattered samples with its own standard error: a Gaussian process.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

// One row a place. Columns fall into groups of one length scale each: `group_end` says where each
// ends; the last group alone makes a second, additive part of the kernel.
struct KrigingCoordinates {
  Eigen::MatrixXd rows;
  std::vector<Eigen::Index> group_end;
};

// What the covariance of samples is made of, for a process of variance one.
struct KrigingScales {
  std::vector<double> length;          // one a group, then the second part's
  double nugget = 1e-3, second = 0.5;  // second: the second part's share u
};

// Matern's correlation of order 5/2 over the squared distance in lengths.
double matern(double square);

// Several quantities over the same places, with one covariance up to a factor:
// (1 - u) m(sum_g d_g^2 / l_g^2) + u m(d_last^2 / l^2), m Matern's of order 5/2, and a nugget
// (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, 2.2 and 4.2). Lengths,
// u and nugget are those under which each sample is likeliest given all others (5.4.2), found on
// up to kFitted samples.
class Kriging {
 public:
  static constexpr Eigen::Index kFitted = 250;

  // `values`: one row a place, of mean zero. Error(kNoConvergence): the covariance is not positive
  // definite. `like`: takes these scales, which need one place at least, instead.
  Kriging(KrigingCoordinates places, const Eigen::MatrixXd& values,
          const KrigingScales* like = nullptr);

  // What the others say of each sample, less the sample (5.10 to 5.12), and the variance of that
  // for a process of variance one, its nugget included.
  const Eigen::MatrixXd& left_out() const { return left_out_; }
  const Eigen::VectorXd& left_out_variance() const { return left_out_variance_; }
  double variance() const { return variance_; }  // the process's, of each quantity

  // At other places, one a row.
  Eigen::MatrixXd covariance(
      const Eigen::MatrixXd& rows) const;  // with the samples: rows x samples
  Eigen::MatrixXd mean(const Eigen::MatrixXd& covariance) const { return covariance * weights_; }
  // Of a process of variance one given the samples, without nugget.
  Eigen::VectorXd posterior_variance(const Eigen::MatrixXd& covariance) const;
  Eigen::MatrixXd posterior_covariance(const Eigen::MatrixXd& rows) const;
  double nugget() const { return scales_.nugget; }
  const KrigingScales& scales() const { return scales_; }
  // One row a sample: mean() is covariance() times these.
  const Eigen::MatrixXd& weights() const { return weights_; }

 private:
  Eigen::MatrixXd between(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                          const KrigingScales& scales) const;
  void choose(const Eigen::MatrixXd& values);

  KrigingCoordinates places_;
  KrigingScales scales_;
  Eigen::MatrixXd inverse_, weights_, left_out_;
  Eigen::VectorXd left_out_variance_;
  double variance_ = 0;
};

}  // namespace hapsim
