#include "diagnose/offset_test.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "estimate/probability.h"

namespace hapsim {
namespace {

// Orthonormal columns that span what a wrong stiffness does to the force of one press.
Eigen::MatrixXd stiffness_errors(const Dataset& dataset, int episode, const Eigen::VectorXd& f) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
      gain_directions(dataset, {episode}, f).front().Z);
  return qr.householderQ() * Eigen::MatrixXd::Identity(f.size(), qr.rank());
}

// Correlation of neighbouring stretches from that of `count` of them about their own mean, which is
// too small by (1 + 4 rho) / count (Kendall, Biometrika 41, 1954), and its standard error on top: a
// false offset costs more than a memory that is thought too long. None below zero.
double stretch_correlation(double about_mean, double count, double pairs) {
  const double unbiased = (about_mean + 1 / count) / (1 - 4 / count);
  return std::clamp(unbiased + 1 / std::sqrt(pairs), 0.0, 0.9);
}

}  // namespace

OffsetTest test_offsets(const Dataset& dataset, const Eigen::VectorXd& residual,
                        const Eigen::VectorXd& forces) {
  constexpr Eigen::Index kStretches = 10;
  OffsetTest test;
  double within = 0, neighbours = 0, offsets = 0, freedom = 0;
  Eigen::Index at = 0;
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e) {
    const auto n = static_cast<Eigen::Index>(dataset.episodes[e].rows.size());
    const Eigen::VectorXd r0 = residual.segment(at, 3 * n);
    const Eigen::VectorXd f = forces.segment(at, 3 * n);
    at += 3 * n;
    if (n < 2 * kStretches) continue;
    const Eigen::MatrixXd Q = stiffness_errors(dataset, static_cast<int>(e), f);
    const Eigen::VectorXd r = r0 - Q * (Q.transpose() * r0);
    Eigen::MatrixXd ones = Eigen::MatrixXd::Zero(3 * n, 3);
    for (Eigen::Index i = 0; i < 3 * n; ++i) ones(i, i % 3) = 1;
    ones -= (Q * (Q.transpose() * ones)).eval();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(ones);
    const Eigen::VectorXd left = r - ones * qr.solve(r);
    test.gain += r.squaredNorm() - left.squaredNorm();
    offsets += static_cast<double>(qr.rank());
    const Eigen::Map<const Eigen::MatrixXd> by_row(left.data(), 3, n);
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (Eigen::Index s = 0; s < kStretches; ++s) {
      const Eigen::Index begin = s * n / kStretches, count = (s + 1) * n / kStretches - begin;
      const Eigen::Vector3d mean =
          by_row.middleCols(begin, count).rowwise().sum() / std::sqrt(static_cast<double>(count));
      within += mean.squaredNorm();
      neighbours += mean.dot(last);
      last = mean;
    }
    freedom += static_cast<double>(3 * kStretches - Q.cols() - qr.rank());
  }
  if (offsets < 6 || within <= 0) return test;
  const double pairs = freedom * (kStretches - 1) / kStretches;
  const double correlation =
      stretch_correlation(neighbours / (kStretches - 1) / (within / kStretches), kStretches, pairs);
  const double spread = (1 + correlation) / (1 - correlation);  // of a press's mean, by that much
  const double alike = correlation * correlation;
  test.p_value = fisher_upper(test.gain / offsets / (spread * within / freedom), offsets,
                              freedom * (1 - alike) / (1 + alike));
  return test;
}

}  // namespace hapsim
