#include "realtime/strain_memory.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "realtime/power_table.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kMemoryAcross = 4;
constexpr std::array<int, kMemoryAcross + 1> kMemoryDeep{6, 4, 4, 2, 1};
constexpr double kMemoryRidge = 1e-7;  // of the columns' squares
constexpr double kMemoryFloor = 0.05;  // of the largest force
constexpr double kMemorySlope = 0.25;  // radii: how far a derivative counts
constexpr double kMemoryPin = 10;      // of the undeformed state, whose response is the stiffness

struct MemoryPowers {
  int i, j, k;
};
// Runs of monomials with the same i and j + k, which turns about d mix among themselves.
struct MemoryRun {
  int first, across;
};

struct MemoryBasis {
  std::array<MemoryPowers, kMemoryTerms> powers{};
  std::array<MemoryRun, 21> runs{};
};

constexpr MemoryBasis memory_basis() {
  MemoryBasis basis;
  int n = 0, r = 0;
  for (int linear = 1; linear >= 0; --linear)
    for (int m = 0; m <= kMemoryAcross; ++m)
      for (int i = 0; i <= kMemoryDeep[static_cast<std::size_t>(m)]; ++i) {
        if (i + m == 0 || (i + m == 1) != (linear == 1)) continue;
        basis.runs[static_cast<std::size_t>(r++)] = {n, m};
        for (int j = m; j >= 0; --j) basis.powers[static_cast<std::size_t>(n++)] = {i, j, m - j};
      }
  return basis;
}
constexpr MemoryBasis kMemoryBasis = memory_basis();

// The runs that the second order has too, and where: one beside the constant.
constexpr int kSecondDegree = 3;
constexpr bool is_second(const MemoryRun& run) {
  return kMemoryBasis.powers[static_cast<std::size_t>(run.first)].i + run.across <= kSecondDegree;
}
constexpr int second_column(const MemoryRun& run) {
  int column = 1;
  for (const MemoryRun& other : kMemoryBasis.runs) {
    if (other.first == run.first) break;
    if (is_second(other)) column += other.across + 1;
  }
  return column;
}
constexpr std::array<int, kSecondTerms> second_monomials() {
  std::array<int, kSecondTerms> all{-1};
  for (const MemoryRun& run : kMemoryBasis.runs)
    for (int b = 0; is_second(run) && b <= run.across; ++b)
      all[static_cast<std::size_t>(second_column(run) + b)] = run.first + b;
  return all;
}
constexpr std::array<int, kSecondTerms> kSecondMonomials = second_monomials();  // -1: the constant

// Least squares with a ridge on scaled columns: x = result y.
MatrixXd ridge_inverse(const MatrixXd& A) {
  const Index rows = A.rows(), n = A.cols();
  const Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-12).cwiseInverse().transpose();
  MatrixXd whole = MatrixXd::Zero(rows + n, n);
  whole.topRows(rows) = A * scale.asDiagonal();
  whole.bottomRows(n).diagonal().setConstant(std::sqrt(kMemoryRidge));
  const MatrixXd right = MatrixXd::Identity(rows + n, rows);
  return scale.asDiagonal() * MatrixXd(whole.colPivHouseholderQr().solve(right));
}

}  // namespace

MemoryPoint memory_point(const Vec3& v, const Vec3& rest) noexcept {
  const PowerTable d(v[0]), p(v[1]), q(v[2]);
  const bool along = !rest.isZero(0);
  MemoryPoint at;
  for (int t = 0; t < kMemoryTerms; ++t) {
    const auto [i, j, k] = kMemoryBasis.powers[static_cast<std::size_t>(t)];
    at.m[t] = d.f[i] * p.f[j] * q.f[k];
    Vec3 g(d.d[i] * p.f[j] * q.f[k], d.f[i] * p.d[j] * q.f[k], d.f[i] * p.f[j] * q.d[k]);
    if (along) {
      at.m[t] += g.dot(rest);
      const double dp = d.d[i] * p.d[j] * q.f[k], dq = d.d[i] * p.f[j] * q.d[k],
                   pq = d.f[i] * p.d[j] * q.d[k];
      g += Vec3(d.dd[i] * p.f[j] * q.f[k] * rest[0] + dp * rest[1] + dq * rest[2],
                dp * rest[0] + d.f[i] * p.dd[j] * q.f[k] * rest[1] + pq * rest[2],
                dq * rest[0] + pq * rest[1] + d.f[i] * p.f[j] * q.dd[k] * rest[2]);
    }
    at.gradient.col(t) = g;
  }
  return at;
}

namespace {

// T[m](a, b): what p^b' q^(m-b') has in the turned p^a' q^(m-a'), a' = m - a.
using Turn = Eigen::Matrix<double, kMemoryAcross + 1, kMemoryAcross + 1>;
using Turns = std::array<Turn, kMemoryAcross + 1>;

Turns turns_of(const Eigen::Matrix2d& R) noexcept {
  Turns T;
  for (int m = 0; m <= kMemoryAcross; ++m) {
    T[static_cast<std::size_t>(m)].setZero();
    for (int a = 0; a <= m; ++a) {
      std::array<double, kMemoryAcross + 2> c{1};  // by the power of q
      for (int k = 0; k < m; ++k) {
        const int row = k < m - a ? 0 : 1;
        for (int b = k + 1; b >= 0; --b)
          c[static_cast<std::size_t>(b)] =
              R(row, 0) * c[static_cast<std::size_t>(b)] +
              (b > 0 ? R(row, 1) * c[static_cast<std::size_t>(b - 1)] : 0);
      }
      for (int b = 0; b <= m; ++b)
        T[static_cast<std::size_t>(m)](a, b) = c[static_cast<std::size_t>(b)];
    }
  }
  return T;
}

void add_turned_second(const SecondMatrix& Q, const Eigen::Matrix3d& R, const Turns& T,
                       double weight, SecondMatrix& sum) noexcept {
  SecondMatrix half = SecondMatrix::Zero();  // in turned monomials
  half.col(0) = Q.col(0);
  for (const MemoryRun& run : kMemoryBasis.runs) {
    if (!is_second(run)) continue;
    const Turn& turn = T[static_cast<std::size_t>(run.across)];
    const int first = second_column(run);
    for (int b = 0; b <= run.across; ++b)
      for (int a = 0; a <= run.across; ++a) half.col(first + b) += turn(a, b) * Q.col(first + a);
  }
  Eigen::Matrix<double, 27, 27> all;  // R' (x) R' (x) R'
  for (int i = 0; i < 27; ++i)
    for (int j = 0; j < 27; ++j)
      all(i, j) = R(j / 9, i / 9) * R(j / 3 % 3, i / 3 % 3) * R(j % 3, i % 3);
  sum.noalias() += weight * (all * half);
}

}  // namespace

Vec3 second_force(const SecondMatrix& Q, const MemoryPoint& at, const Vec3& x) noexcept {
  Eigen::Matrix<double, 27, 1> here = Q.col(0);
  for (int e = 1; e < kSecondTerms; ++e)
    here += at.m[kSecondMonomials[static_cast<std::size_t>(e)]] * Q.col(e);
  Vec3 f = Vec3::Zero();
  for (int b = 0; b < 3; ++b)
    for (int c = 0; c < 3; ++c) f += x[b] * x[c] * here.segment<3>(9 * b + 3 * c);
  return f;
}

void add_turned(const StrainMemory& of, const Eigen::Matrix3d& R, double weight,
                StrainMemory& sum) noexcept {
  if ((R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-14) {
    sum.C += weight * of.C;
    sum.Q += weight * of.Q;
    return;
  }
  const Turns T = turns_of(R.bottomRightCorner<2, 2>());
  add_turned_second(of.Q, R, T, weight, sum.Q);
  MemoryMatrix half;  // C T
  for (const MemoryRun& run : kMemoryBasis.runs) {
    const int size = run.across + 1;
    const Turn& turn = T[static_cast<std::size_t>(run.across)];
    for (int b = 0; b < size; ++b) {
      half.col(run.first + b) = turn(0, b) * of.C.col(run.first);
      for (int a = 1; a < size; ++a)
        half.col(run.first + b) += turn(a, b) * of.C.col(run.first + a);
    }
  }
  for (const MemoryRun& run : kMemoryBasis.runs) {
    const int size = run.across + 1;
    const Turn& turn = T[static_cast<std::size_t>(run.across)];
    for (int column = 0; column < kMemoryTerms; ++column)
      for (int b = 0; b < size; ++b) {
        double value = 0;
        for (int a = 0; a < size; ++a) value += turn(a, b) * half(run.first + a, column);
        sum.C(run.first + b, column) += weight * value;
      }
  }
}

void StressStates::add(const Vec3& v, const StressResponse& response) {
  v_.push_back(v);
  Eigen::MatrixXf stress(response.stress.size(), 4);
  stress.col(0) = response.stress.cast<float>();
  stress.rightCols<3>() = (radius_ * response.changes * frame_.transpose()).cast<float>();
  stress_.push_back(std::move(stress));
  work_.push_back((response.work * frame_.transpose()).cast<float>());
  strain_.push_back(response.strain.cast<float>());
  Eigen::Matrix<double, 27, 1> coupling = Eigen::Matrix<double, 27, 1>::Zero();
  for (int b = 0; b < 3 && !response.coupling.empty(); ++b)
    for (int c = 0; c < 3; ++c) {
      Vec3 along;
      for (int j = 0; j < 3; ++j) along[j] = response.coupling[static_cast<std::size_t>(j)](b, c);
      coupling.segment<3>(9 * b + 3 * c) = radius_ / unit_ * (frame_ * along);
    }
  coupling_.push_back(coupling);
}

MatrixXd StressStates::forces() const {
  const auto n = static_cast<Index>(v_.size());
  MatrixXd F(3 * n, 4 * n);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i)
      F.block<3, 4>(3 * j, 4 * i) =
          (radius_ / unit_) *
          (work_[static_cast<std::size_t>(j)].transpose() * stress_[static_cast<std::size_t>(i)])
              .cast<double>();
  return F;
}

MatrixXd StressStates::works() const {
  const auto n = static_cast<Index>(v_.size());
  MatrixXd W(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i)
      W(j, i) =
          strain_[static_cast<std::size_t>(j)].dot(stress_[static_cast<std::size_t>(i)].col(0)) /
          unit_;
  return W;
}

StrainMemory StressStates::fit(double& error) const {
  const auto n = static_cast<Index>(v_.size());
  const MatrixXd F = forces();
  Eigen::VectorXd size(n);  // of the static force
  for (Index i = 0; i < n; ++i) size[i] = F.block<3, 1>(3 * i, 4 * i).norm();
  const double floor = kMemoryFloor * size.maxCoeff();
  MatrixXd now(3 * n, kMemoryTerms), before(4 * n, kMemoryTerms);  // m' and (m, m') of the states
  Eigen::VectorXd rows(3 * n), columns(4 * n);
  for (Index i = 0; i < n; ++i) {
    const Vec3& v = v_[static_cast<std::size_t>(i)];
    const MemoryPoint at = memory_point(v);
    now.middleRows<3>(3 * i) = at.gradient;
    before.row(4 * i) = at.m.transpose();
    before.middleRows<3>(4 * i + 1) = at.gradient;
    const double pin = v.isZero(0) ? kMemoryPin : 1;
    rows.segment<3>(3 * i).setConstant(pin);
    columns[4 * i] = 1 / std::max(size[i], floor);
    columns.segment<3>(4 * i + 1).setConstant(pin * kMemorySlope * columns[4 * i]);
  }
  const MatrixXd left = ridge_inverse(rows.asDiagonal() * now) * rows.asDiagonal(),
                 right = ridge_inverse(columns.asDiagonal() * before) * columns.asDiagonal();
  StrainMemory memory;
  memory.C = left * F * right.transpose();
  MatrixXd second(n, kSecondTerms), couplings(n, 27);
  for (Index i = 0; i < n; ++i) {
    for (int e = 0; e < kSecondTerms; ++e)
      second(i, e) = e == 0 ? 1 : before(4 * i, kSecondMonomials[static_cast<std::size_t>(e)]);
    couplings.row(i) = coupling_[static_cast<std::size_t>(i)].transpose();
  }
  memory.Q = (ridge_inverse(second) * couplings).transpose();
  const MatrixXd off = now * memory.C * before.transpose() - F;
  double squares = 0, count = 0;
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i) {
      const double here = F.block<3, 1>(3 * j, 4 * i).norm();
      squares += std::pow(off.block<3, 1>(3 * j, 4 * i).norm() / std::max(here, floor), 2);
      ++count;
    }
  error = std::sqrt(squares / count);
  return memory;
}

MatrixXd stress_modes(const std::vector<Vec3>& v, const std::vector<Eigen::VectorXd>& s) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  MatrixXd sum = MatrixXd::Zero(s.front().size(), 3);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i].isZero(0)) continue;
    const double weight = 1 / v[i].squaredNorm();
    squares += weight * v[i] * v[i].transpose();
    sum += weight * s[i] * v[i].transpose();
  }
  return sum * squares.inverse();
}

}  // namespace hapsim
