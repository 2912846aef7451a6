#include "diagnose/offset_test.h"

#include <Eigen/Dense>

#include "diagnose/probability.h"

namespace hapsim {
namespace {

// Orthonormal columns that span what a wrong stiffness does to the force of one press.
Eigen::MatrixXd stiffness_errors(const Dataset& dataset, int episode, const Eigen::VectorXd& f) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
      gain_directions(dataset, {episode}, f).front().Z);
  return qr.householderQ() * Eigen::MatrixXd::Identity(f.size(), qr.rank());
}

}  // namespace

OffsetTest test_offsets(const Dataset& dataset, const Eigen::VectorXd& residual,
                        const Eigen::VectorXd& forces) {
  constexpr Eigen::Index kStretches = 10;
  OffsetTest test;
  double within = 0, offsets = 0, freedom = 0;
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
    for (Eigen::Index s = 0; s < kStretches; ++s) {
      const Eigen::Index begin = s * n / kStretches, count = (s + 1) * n / kStretches - begin;
      within += by_row.middleCols(begin, count).rowwise().sum().squaredNorm() /
                static_cast<double>(count);
    }
    freedom += static_cast<double>(3 * kStretches - Q.cols() - qr.rank());
  }
  if (offsets < 6 || within <= 0) return test;
  test.p_value = fisher_upper(test.gain / offsets / (within / freedom), offsets, freedom);
  return test;
}

}  // namespace hapsim
