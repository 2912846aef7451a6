#include "estimate/quadratic_program.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace hapsim {
namespace {

// In coordinates z = L'd, H = L L', the goal is the distance from its own minimum, and rows are of
// length one.
class DualActiveSet {
 public:
  explicit DualActiveSet(const QuadraticProgram& p) : p_(p), llt_(p.H) {
    normals_ = p.A.transpose();
    llt_.matrixL().solveInPlace(normals_);
    size_ = normals_.colwise().norm().transpose();
    offset_ = p.b;
    for (Eigen::Index c = 0; c < size_.size(); ++c) {
      if (!(size_[c] > 0)) continue;
      normals_.col(c) /= size_[c];
      offset_[c] /= size_[c];
    }
    z_ = -p.f;
    llt_.matrixL().solveInPlace(z_);
  }

  std::optional<QuadraticEnd> run() {
    if (llt_.info() != Eigen::Success || !z_.allFinite() || !normals_.allFinite())
      return std::nullopt;
    const Eigen::Index most = 20 + 10 * (p_.A.rows() + p_.A.cols());
    for (Eigen::Index k = 0; k < most; ++k) {
      const Eigen::Index broken = most_broken();
      if (broken < 0) return end();
      if (!add(broken)) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  bool is_equality(Eigen::Index c) const { return p_.equality[static_cast<std::size_t>(c)]; }
  double slack(Eigen::Index c) const { return normals_.col(c).dot(z_) - offset_[c]; }

  // Equalities first: they stay for good. -1: none.
  Eigen::Index most_broken() const {
    Eigen::Index found = -1;
    double most = 1e-12 * (1 + z_.norm());
    for (const bool equal : {true, false}) {
      for (Eigen::Index c = 0; c < p_.A.rows(); ++c) {
        if (is_equality(c) != equal) continue;
        if (std::find(active_.begin(), active_.end(), c) != active_.end()) continue;
        const double by = equal ? std::abs(slack(c)) : -slack(c);
        if (!(by > most)) continue;
        most = by;
        found = c;
      }
      if (found >= 0) break;
    }
    return found;
  }

  bool add(Eigen::Index c) {
    const double sign = slack(c) > 0 ? -1 : 1;  // an equality may be broken either way
    const Eigen::VectorXd normal = sign * normals_.col(c);
    double own = 0;
    for (std::size_t drops = active_.size() + 1; drops > 0; --drops) {
      const auto k = static_cast<Eigen::Index>(active_.size());
      Eigen::VectorXd share(k), way = normal;
      if (k > 0) {
        Eigen::MatrixXd N(normal.size(), k);
        for (Eigen::Index j = 0; j < k; ++j)
          N.col(j) = sign_[static_cast<std::size_t>(j)] *
                     normals_.col(active_[static_cast<std::size_t>(j)]);
        share = N.colPivHouseholderQr().solve(normal);
        way -= N * share;
      }
      constexpr double kParallel = 1e-10;  // to what is active
      const double room = way.squaredNorm();
      const bool moves = room > kParallel * kParallel;
      double length = moves ? -sign * slack(c) / room : std::numeric_limits<double>::infinity();
      std::ptrdiff_t first = -1;
      for (std::ptrdiff_t j = 0; j < k; ++j) {
        if (is_equality(active_[static_cast<std::size_t>(j)]) || !(share[j] > 1e-14)) continue;
        const double until = factor_[static_cast<std::size_t>(j)] / share[j];
        if (!(until < length)) continue;
        length = until;
        first = j;
      }
      if (!std::isfinite(length)) return false;
      if (moves) z_ += length * way;
      for (Eigen::Index j = 0; j < k; ++j)
        factor_[static_cast<std::size_t>(j)] -= length * share[j];
      own += length;
      if (first < 0) {
        active_.push_back(c);
        sign_.push_back(sign);
        factor_.push_back(own);
        return true;
      }
      active_.erase(active_.begin() + first);
      sign_.erase(sign_.begin() + first);
      factor_.erase(factor_.begin() + first);
    }
    return false;
  }

  QuadraticEnd end() const {
    QuadraticEnd result{z_, Eigen::VectorXd::Zero(p_.A.rows())};
    llt_.matrixU().solveInPlace(result.d);
    for (std::size_t j = 0; j < active_.size(); ++j)
      result.multiplier[active_[j]] = sign_[j] * factor_[j] / size_[active_[j]];
    return result;
  }

  const QuadraticProgram& p_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::MatrixXd normals_;
  Eigen::VectorXd size_, offset_, z_;
  std::vector<Eigen::Index> active_;
  std::vector<double> sign_, factor_;
};

}  // namespace

std::optional<QuadraticEnd> solve(const QuadraticProgram& program) {
  return DualActiveSet(program).run();
}

}  // namespace hapsim
