#include "estimate/kriging.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Squared distances between rows of a and b over columns [begin, end).
MatrixXd squares(const MatrixXd& a, const MatrixXd& b, Index begin, Index end) {
  const auto A = a.middleCols(begin, end - begin), B = b.middleCols(begin, end - begin);
  MatrixXd d = -2 * A * B.transpose();
  d.colwise() += A.rowwise().squaredNorm().eval();
  d.rowwise() += B.rowwise().squaredNorm().transpose().eval();
  return d.cwiseMax(0.0);
}

struct LeftOut {
  MatrixXd inverse;
  VectorXd variance;
  double process = 0, objective = std::numeric_limits<double>::infinity();
};

// `covariance` with its nugget; the process's variance is the likeliest one.
LeftOut leave_out(const MatrixXd& covariance, const MatrixXd& values) {
  LeftOut result;
  const Eigen::LLT<MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success) return result;
  const Index n = covariance.rows();
  result.inverse = factor.solve(MatrixXd::Identity(n, n));
  result.variance = result.inverse.diagonal().cwiseInverse();
  const MatrixXd weighted = result.inverse * values;
  double chi = 0, logs = 0;
  for (Index i = 0; i < n; ++i) {
    chi += weighted.row(i).squaredNorm() * result.variance[i];
    logs += std::log(result.variance[i]);
  }
  result.process = chi / static_cast<double>(values.size());
  result.objective = std::log(std::max(result.process, 1e-300)) + logs / static_cast<double>(n);
  return result;
}

MatrixXd with_nugget(MatrixXd covariance, double nugget) {
  covariance.diagonal().array() += nugget;
  return covariance;
}

}  // namespace

double matern(double square) {
  const double r = std::sqrt(5 * square);
  return (1 + r + r * r / 3) * std::exp(-r);
}

Kriging::Kriging(KrigingCoordinates places, const MatrixXd& values, const KrigingScales* like)
    : places_(std::move(places)) {
  if (like != nullptr)
    scales_ = *like;
  else
    choose(values);
  LeftOut left =
      leave_out(with_nugget(between(places_.rows, places_.rows, scales_), scales_.nugget), values);
  if (left.inverse.size() == 0)
    fail_numerics("", "the covariance of the samples is not positive definite",
                  "give samples apart from each other");
  inverse_ = std::move(left.inverse);
  left_out_variance_ = left.variance;
  variance_ = left.process;
  weights_ = inverse_ * values;
  left_out_ = -(left_out_variance_.asDiagonal() * weights_);
}

MatrixXd Kriging::between(const MatrixXd& a, const MatrixXd& b, const KrigingScales& scales) const {
  MatrixXd all = MatrixXd::Zero(a.rows(), b.rows()), last;
  Index begin = 0;
  for (std::size_t g = 0; g < places_.group_end.size(); ++g) {
    last = squares(a, b, begin, places_.group_end[g]);
    all += last / (scales.length[g] * scales.length[g]);
    begin = places_.group_end[g];
  }
  const double l = scales.length.back();
  return (1 - scales.second) * all.unaryExpr(&matern) +
         scales.second * (last / (l * l)).unaryExpr(&matern);
}

void Kriging::choose(const MatrixXd& values) {
  const Index n = places_.rows.rows(), used = std::min(n, kFitted);
  MatrixXd rows(used, places_.rows.cols()), chosen(used, values.cols());
  for (Index i = 0; i < used; ++i) {
    rows.row(i) = places_.rows.row(i * n / used);
    chosen.row(i) = values.row(i * n / used);
  }
  // Coordinate search over logarithms: lengths, nugget, and the second part's odds.
  const std::size_t groups = places_.group_end.size();
  std::vector<double> x;
  Index begin = 0;
  for (const Index end : places_.group_end) {
    const MatrixXd d = squares(rows, rows, begin, end);
    x.push_back(0.5 * std::log(std::max(d.mean(), 1e-12)));
    begin = end;
  }
  x.push_back(x.back() - 0.7);
  x.push_back(std::log(1e-3));
  x.push_back(0);
  const auto scales_of = [&](const std::vector<double>& v) {
    KrigingScales scales;
    for (std::size_t g = 0; g <= groups; ++g) scales.length.push_back(std::exp(v[g]));
    scales.nugget = std::clamp(std::exp(v[groups + 1]), 1e-6, 10.0);
    scales.second = 1 / (1 + std::exp(-v[groups + 2]));
    return scales;
  };
  const auto objective = [&](const std::vector<double>& v) {
    const KrigingScales scales = scales_of(v);
    return leave_out(with_nugget(between(rows, rows, scales), scales.nugget), chosen).objective;
  };
  double best = objective(x);
  std::vector<double> step(x.size(), 0.7);
  for (int round = 0; round < 6; ++round)
    for (std::size_t k = 0; k < x.size(); ++k) {
      bool better = false;
      for (const double sign : {1.0, -1.0}) {
        std::vector<double> trial = x;
        trial[k] += sign * step[k];
        if (const double value = objective(trial); value < best) {
          best = value, x = trial, better = true;
          break;
        }
      }
      step[k] *= better ? 1.3 : 0.5;
    }
  scales_ = scales_of(x);
}

MatrixXd Kriging::covariance(const MatrixXd& rows) const {
  return between(rows, places_.rows, scales_);
}

VectorXd Kriging::posterior_variance(const MatrixXd& covariance) const {
  return (1 - (covariance * inverse_).cwiseProduct(covariance).rowwise().sum().array())
      .cwiseMax(0.0)
      .matrix();
}

MatrixXd Kriging::posterior_covariance(const MatrixXd& rows) const {
  const MatrixXd with = covariance(rows);
  return between(rows, rows, scales_) - with * inverse_ * with.transpose();
}

}  // namespace hapsim
