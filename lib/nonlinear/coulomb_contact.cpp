#include "nonlinear/coulomb_contact.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

enum class Touch : char { kOpen, kStick, kSlip };

class Problem {
 public:
  Problem(const MatrixXd& compliance, const VectorXd& apart, const std::vector<double>& friction)
      : C_(compliance), w0_(apart), mu_(friction), m_(apart.size() / 3) {
    for (Index i = 0; i < m_; ++i) {
      normal_.push_back(1 / C_(3 * i, 3 * i));
      tangential_.push_back(1 / std::max(C_(3 * i + 1, 3 * i + 1), C_(3 * i + 2, 3 * i + 2)));
    }
  }

  bool newton(VectorXd& p) const {
    std::vector<Touch> before;
    for (int k = 0; k < 30; ++k) {
      VectorXd w = C_ * p + w0_;
      const std::vector<Touch> touch = states(p, w);
      for (Index i = 0; i < m_; ++i)
        if (touch[i] == Touch::kOpen) p.segment<3>(3 * i).setZero();
      w = C_ * p + w0_;
      const Linear system = linear(p, w, touch);
      if (touch == before && system.error <= 1e-11 * (1e-300 + p.lpNorm<Eigen::Infinity>()))
        return true;
      before = touch;
      if (system.unknown.empty()) continue;
      const VectorXd change = system.J.partialPivLu().solve(-system.F);
      if (!change.allFinite()) return false;
      for (std::size_t a = 0; a < system.unknown.size(); ++a)
        p[system.unknown[a]] += change[static_cast<Index>(a)];
    }
    return false;
  }

  void relax(VectorXd& p, int sweeps) const {
    for (int k = 0; k < sweeps; ++k)
      for (Index i = 0; i < m_; ++i) {
        p[3 * i] = std::max(0.0, p[3 * i] - normal_[i] * w(3 * i, p));
        if (mu_[i] == 0 || p[3 * i] == 0) {
          p.segment<2>(3 * i + 1).setZero();
          continue;
        }
        Eigen::Vector2d t = p.segment<2>(3 * i + 1);
        t -= 0.7 * tangential_[i] * Eigen::Vector2d(w(3 * i + 1, p), w(3 * i + 2, p));
        const double bound = mu_[i] * p[3 * i], length = t.norm();
        p.segment<2>(3 * i + 1) = length > bound ? Eigen::Vector2d(bound / length * t) : t;
      }
  }

 private:
  struct Linear {
    std::vector<Index> unknown;
    MatrixXd J;
    VectorXd F;
    double error = 0;  // in tractions
  };

  double w(Index row, const VectorXd& p) const { return C_.col(row).dot(p) + w0_[row]; }

  std::vector<Touch> states(const VectorXd& p, const VectorXd& w) const {
    std::vector<Touch> touch(static_cast<std::size_t>(m_), Touch::kOpen);
    for (Index i = 0; i < m_; ++i) {
      const double y = p[3 * i] - normal_[i] * w[3 * i];
      if (!(y > 0)) continue;
      touch[i] = Touch::kStick;
      if (mu_[i] == 0 || !std::isfinite(mu_[i])) continue;
      if (trial(i, p, w).norm() > mu_[i] * std::max(0.0, p[3 * i])) touch[i] = Touch::kSlip;
    }
    return touch;
  }
  Eigen::Vector2d trial(Index i, const VectorXd& p, const VectorXd& w) const {
    return p.segment<2>(3 * i + 1) - tangential_[i] * w.segment<2>(3 * i + 1);
  }

  Linear linear(const VectorXd& p, const VectorXd& w, const std::vector<Touch>& touch) const {
    Linear s;
    for (Index i = 0; i < m_; ++i)
      if (touch[i] != Touch::kOpen)
        for (int c = 0; c < (mu_[i] == 0 ? 1 : 3); ++c) s.unknown.push_back(3 * i + c);
    const Index size = static_cast<Index>(s.unknown.size());
    const MatrixXd C = C_(s.unknown, s.unknown);
    s.J = MatrixXd::Zero(size, size);
    s.F = VectorXd::Zero(size);
    for (Index a = 0, parts = 1; a < size; a += parts) {
      const Index i = s.unknown[static_cast<std::size_t>(a)] / 3;
      s.J.row(a) = normal_[i] * C.row(a);
      s.F[a] = normal_[i] * w[3 * i];
      parts = mu_[i] == 0 ? 1 : 3;
      if (parts == 1) continue;
      const auto Ct = C.middleRows(a + 1, 2);
      if (touch[i] == Touch::kStick) {
        s.J.middleRows(a + 1, 2) = tangential_[i] * Ct;
        s.F.segment<2>(a + 1) = tangential_[i] * w.segment<2>(3 * i + 1);
        continue;
      }
      const Eigen::Vector2d y = trial(i, p, w), along = y.normalized();
      const double bound = mu_[i] * std::max(0.0, p[3 * i]);
      const Eigen::Matrix2d turn =
          bound / y.norm() * (Eigen::Matrix2d::Identity() - along * along.transpose());
      s.J.middleRows(a + 1, 2) = tangential_[i] * turn * Ct;
      s.J.block<2, 2>(a + 1, a + 1) += Eigen::Matrix2d::Identity() - turn;
      s.J.block<2, 1>(a + 1, a) -= mu_[i] * along;
      s.F.segment<2>(a + 1) = p.segment<2>(3 * i + 1) - bound * along;
    }
    s.error = size > 0 ? s.F.lpNorm<Eigen::Infinity>() : 0;
    return s;
  }

  const MatrixXd& C_;
  const VectorXd& w0_;
  const std::vector<double>& mu_;
  Index m_;
  std::vector<double> normal_, tangential_;  // of each place: 1 / its own compliance
};

}  // namespace

bool solve_coulomb_contact(const MatrixXd& compliance, const VectorXd& apart,
                           const std::vector<double>& friction, VectorXd& traction) {
  const Problem problem(compliance, apart, friction);
  for (const int sweeps : {0, 100, 400, 1600}) {
    problem.relax(traction, sweeps);
    if (problem.newton(traction)) return true;
  }
  return false;
}

}  // namespace hapsim
