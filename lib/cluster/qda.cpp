#include "cluster/qda.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hapsim {
namespace {

// Sum of log p(own class | x) over the samples, each judged by the others; -inf when one class
// cannot be formed without it, unless it is that class's only sample.
double left_out_score(const Eigen::MatrixXd& points, const std::vector<int>& label, int classes,
                      const QdaOptions& options) {
  double score = 0;
  const auto n = static_cast<int>(label.size());
  for (int out = 0; out < n; ++out) {
    if (std::count(label.begin(), label.end(), label[out]) == 1) continue;
    std::vector<int> kept, kept_label;
    for (int i = 0; i < n; ++i)
      if (i != out) kept.push_back(i), kept_label.push_back(label[i]);
    const Qda qda(points(kept, Eigen::all), kept_label, classes, options);
    if (qda.singular()) return -std::numeric_limits<double>::infinity();
    score += qda.log_posterior(points.row(out).transpose())[label[out]];
  }
  return score;
}

}  // namespace

Qda::Qda(const Eigen::MatrixXd& points, const std::vector<int>& label, int classes,
         const QdaOptions& options)
    : options_(options) {
  const Eigen::Index d = points.cols();
  std::vector<Eigen::MatrixXd> scatter(classes, Eigen::MatrixXd::Zero(d, d));
  std::vector<double> count(classes, 0);
  classes_.resize(classes);
  for (Class& c : classes_) c.mean = Eigen::VectorXd::Zero(d);
  for (std::size_t i = 0; i < label.size(); ++i) {
    classes_[label[i]].mean += points.row(static_cast<Eigen::Index>(i)).transpose();
    count[label[i]] += 1;
  }
  for (int k = 0; k < classes; ++k) classes_[k].mean /= std::max(1.0, count[k]);
  Eigen::MatrixXd pooled = Eigen::MatrixXd::Zero(d, d);
  for (std::size_t i = 0; i < label.size(); ++i) {
    const Eigen::VectorXd off =
        points.row(static_cast<Eigen::Index>(i)).transpose() - classes_[label[i]].mean;
    scatter[label[i]] += off * off.transpose();
    pooled += off * off.transpose();
  }
  const double n = static_cast<double>(label.size());
  pooled /= std::max(1.0, n - classes);
  for (int k = 0; k < classes; ++k) {
    const bool single = count[k] < 2;
    const Eigen::MatrixXd own = single ? pooled : scatter[k] / (count[k] - 1);
    Eigen::MatrixXd covariance = (1 - options.pooled) * own + options.pooled * pooled;
    covariance = ((1 - options.sphere) * covariance + options.sphere * covariance.trace() /
                                                          static_cast<double>(d) *
                                                          Eigen::MatrixXd::Identity(d, d))
                     .eval();
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
    const double largest = covariance.diagonal().maxCoeff();
    const Eigen::MatrixXd L = llt.matrixL();
    if (llt.info() != Eigen::Success || !(largest > 0) ||
        L.diagonal().minCoeff() < 1e-4 * std::sqrt(largest)) {
      singular_ = true;
      return;
    }
    Class& c = classes_[k];
    c.whitener = L.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(d, d));
    c.constant = std::log(std::max(count[k], 1e-300) / n) - L.diagonal().array().log().sum() -
                 0.5 * static_cast<double>(d) * std::log(2 * std::numbers::pi);
  }
}

Eigen::VectorXd Qda::log_joint(const Eigen::VectorXd& x) const {
  Eigen::VectorXd g(static_cast<Eigen::Index>(classes_.size()));
  for (Eigen::Index k = 0; k < g.size(); ++k)
    g[k] =
        classes_[k].constant - 0.5 * (classes_[k].whitener * (x - classes_[k].mean)).squaredNorm();
  return g;
}

Eigen::VectorXd Qda::log_posterior(const Eigen::VectorXd& x) const {
  const Eigen::VectorXd g = log_joint(x);
  const double largest = g.maxCoeff();
  return g.array() - (largest + std::log((g.array() - largest).exp().sum()));
}

int Qda::classify(const Eigen::VectorXd& x) const {
  Eigen::Index best = 0;
  log_joint(x).maxCoeff(&best);
  return static_cast<int>(best);
}

Qda choose_qda(const Eigen::MatrixXd& points, const std::vector<int>& label, int classes) {
  QdaOptions best{1, 1};
  double best_score = -std::numeric_limits<double>::infinity();
  int least_wrong = static_cast<int>(label.size()) + 1;
  for (const double sphere : {0.0, 0.1, 0.3, 1.0})
    for (const double pooled : {0.0, 0.1, 0.25, 0.5, 1.0}) {
      const QdaOptions options{pooled, sphere};
      const Qda qda(points, label, classes, options);
      if (qda.singular()) continue;
      int wrong = 0;
      for (std::size_t i = 0; i < label.size(); ++i)
        wrong += qda.classify(points.row(static_cast<Eigen::Index>(i)).transpose()) != label[i];
      const double score = left_out_score(points, label, classes, options);
      if (wrong < least_wrong || (wrong == least_wrong && score > best_score + 1e-9)) {
        least_wrong = wrong;
        best_score = score;
        best = options;
      }
    }
  return Qda(points, label, classes, best);
}

}  // namespace hapsim
