#include "imaging/lump_errors.h"

#include <Eigen/Dense>

namespace hapsim {

LumpErrors::LumpErrors(const LumpData& data, double common, const Eigen::MatrixXd& slopes)
    : standard_(data.gain.size()) {
  const Eigen::Index n = data.gain.size();
  for (Eigen::Index v = 0; v < n;) {
    Eigen::Index end = v;
    while (end < n && data.position[end] == data.position[v]) ++end;
    const Eigen::Index k = end - v;
    Eigen::MatrixXd V = Eigen::MatrixXd::Constant(k, k, common * common);
    V.diagonal() += data.noise.segment(v, k).cwiseAbs2();
    if (slopes.size() > 0) {
      const Eigen::MatrixXd s = data.off * slopes.middleRows(v, k);
      V += s * s.transpose();
    }
    standard_.segment(v, k) = V.diagonal().cwiseSqrt();
    first_.push_back(v);
    inverse_.push_back(V.llt().matrixL().solve(Eigen::MatrixXd::Identity(k, k)));
    v = end;
  }
  first_.push_back(n);
  free_.resize(n, 0);
  for (Eigen::Index c = 0; c < data.free.cols(); ++c) {
    const Eigen::VectorXd whole = white(data.free.col(c));
    // Twice, for what rounding leaves; a direction that the others span is none.
    const double before = data.free.col(c).cwiseQuotient(standard_).norm();
    if (!(whole.norm() > 1e-3 * before)) continue;
    free_.conservativeResize(n, free_.cols() + 1);
    free_.rightCols<1>() = whole.normalized();
  }
}

Eigen::VectorXd LumpErrors::white(const Eigen::VectorXd& signal) const {
  Eigen::VectorXd w(signal.size());
  for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
    const Eigen::Index v = first_[p], k = first_[p + 1] - v;
    w.segment(v, k).noalias() = inverse_[p] * signal.segment(v, k);
  }
  if (free_.cols() > 0) w -= free_ * (free_.transpose() * w).eval();
  return w;
}

}  // namespace hapsim
