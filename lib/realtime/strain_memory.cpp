#include "realtime/strain_memory.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kMemoryRidge = 1e-7;  // of the columns' squares
constexpr double kInsideRidge = 1e-4;  // the same of InsideMemory
constexpr double kMemoryFloor = 0.05;  // of the largest force
constexpr double kMemorySlope = 0.25;  // radii: how far a derivative counts
constexpr double kMemoryPin = 10;      // of the undeformed state, whose response is the stiffness
// Of states that are farthest aside: the surface folds beside the tool there, which polynomials do
// not follow, and at full weight they spoil the states between.
constexpr double kMemoryAside = 0.3;

const MemorySet& whole_memory() {
  static const MemorySet set = memory_set(1, 6);
  return set;
}

// Least squares with a ridge on scaled columns: x = result y.
MatrixXd ridge_inverse(const MatrixXd& A, double ridge = kMemoryRidge) {
  const Index rows = A.rows(), n = A.cols();
  const Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-12).cwiseInverse().transpose();
  MatrixXd whole = MatrixXd::Zero(rows + n, n);
  whole.topRows(rows) = A * scale.asDiagonal();
  whole.bottomRows(n).diagonal().setConstant(std::sqrt(ridge));
  const MatrixXd right = MatrixXd::Identity(rows + n, rows);
  return scale.asDiagonal() * MatrixXd(whole.colPivHouseholderQr().solve(right));
}

// 1 to half of strain_side(), kMemoryAside at all of it.
double aside_weight(const Vec3& v) {
  const double share = std::hypot(v[1], v[2]) / strain_side(v[0]);
  return 1 - (1 - kMemoryAside) * std::clamp(2 * share - 1, 0.0, 1.0);
}

// Values of a set's monomials at states, a row each.
template <int N>
MatrixXd values_of(const MemorySet& set, const std::vector<Vec3>& v) {
  MatrixXd values(static_cast<Index>(v.size()), N);
  for (std::size_t i = 0; i < v.size(); ++i)
    values.row(static_cast<Index>(i)) = MemoryPart<N>(set, memory_point(v[i])).m.transpose();
  return values;
}

}  // namespace

void add_turned(const StrainMemory& of, const Eigen::Matrix3d& R, double weight,
                StrainMemory& sum) noexcept {
  const MemoryTurn turn(R);
  const MemorySet& all = whole_memory();
  MemoryMatrix half, turned;
  turn.turn(all, of.C.data(), half.data(), kMemoryTerms, 1);
  turn.turn(all, half.data(), turned.data(), 1, kMemoryTerms);
  sum.C += weight * turned;
  add_turned(of.inside, turn, weight, sum.inside);
}

void StressStates::add(const Vec3& v, const StressResponse& response) {
  v_.push_back(v);
  Eigen::MatrixXf stress(response.stress.size(), 4);
  stress.col(0) = response.stress.cast<float>();
  stress.rightCols<3>() = (radius_ * response.changes * frame_.transpose()).cast<float>();
  stress_.push_back(std::move(stress));
  work_.push_back((response.work * frame_.transpose()).cast<float>());
  strain_.push_back(response.strain.cast<float>());
  if (response.inside_work.cols() == 0) return;
  inside_work_.push_back(response.inside_work.cast<float>());
  inside_changes_.push_back(response.inside_changes.cast<float>());
  stiffness_.emplace_back(response.inside_changes.transpose() * response.inside_work / unit_);
  stressed_.emplace_back(response.inside_stressed / unit_);
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
  Eigen::VectorXd rows(3 * n), columns(4 * n), values(n);
  for (Index i = 0; i < n; ++i) {
    const Vec3& v = v_[static_cast<std::size_t>(i)];
    const MemoryPoint at = memory_point(v);
    now.middleRows<3>(3 * i) = at.gradient;
    before.row(4 * i) = at.m.transpose();
    before.middleRows<3>(4 * i + 1) = at.gradient;
    const double pin = v.isZero(0) ? kMemoryPin : 1;
    columns[4 * i] = values[i] = aside_weight(v) / std::max(size[i], floor);
    rows.segment<3>(3 * i).setConstant(pin * values[i]);
    columns.segment<3>(4 * i + 1).setConstant(pin * kMemorySlope * columns[4 * i]);
  }
  const MatrixXd left = ridge_inverse(rows.asDiagonal() * now) * rows.asDiagonal(),
                 right = ridge_inverse(columns.asDiagonal() * before) * columns.asDiagonal();
  StrainMemory memory;
  memory.C = left * F * right.transpose();
  if (!inside_work_.empty()) fit_inside(values, memory.inside);
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

// `weights`: of the stresses of each state.
void StressStates::fit_inside(const Eigen::VectorXd& weights, InsideMemory& inside) const {
  const std::size_t states = v_.size();
  Eigen::VectorXd pinned = weights;  // so that A stays positive where the inside is soft
  for (std::size_t i = 0; i < states; ++i)
    if (v_[i].isZero(0)) pinned[static_cast<Index>(i)] *= kMemoryPin;
  const MatrixXd now = pinned.asDiagonal() * values_of<kInsideNow>(inside_now(), v_),
                 before = weights.asDiagonal() * values_of<kInsideBefore>(inside_before(), v_),
                 left = ridge_inverse(now, kInsideRidge) * pinned.asDiagonal(),
                 right = ridge_inverse(before, kInsideRidge) * weights.asDiagonal();
  // On the fields at i by stresses of each state, and by the fields' stresses at i on strains.
  MatrixXd works(kInsideFields, static_cast<Index>(states)), done = works;
  for (std::size_t i = 0; i < states; ++i) {
    for (std::size_t k = 0; k < states; ++k) {
      const auto column = static_cast<Index>(k);
      works.col(column) = (inside_work_[i].transpose() * stress_[k].col(0)).cast<double>();
      done.col(column) = (inside_changes_[i].transpose() * strain_[k]).cast<double>();
    }
    const MatrixXd g = works * right.transpose() / unit_, w = done * right.transpose() / unit_;
    const auto row = static_cast<Index>(i);
    for (int n = 0; n < kInsideNow; ++n) {
      inside.g.middleRows<kInsideFields>(kInsideFields * n) += left(n, row) * g;
      inside.w.middleRows<kInsideFields>(kInsideFields * n) += left(n, row) * w;
    }
    using Flat = Eigen::Map<const Eigen::Matrix<double, kInsideFields * kInsideFields, 1>>;
    inside.stiffness += Flat(stiffness_[i].data()) * left.col(row).transpose();
    inside.stressed += Flat(stressed_[i].data()) * right.col(row).transpose();
  }
}

MatrixXd inside_weights(const std::vector<Vec3>& v) {
  Eigen::VectorXd weights(static_cast<Index>(v.size()));
  for (std::size_t i = 0; i < v.size(); ++i)
    weights[static_cast<Index>(i)] = v[i].isZero(0) ? 0 : 1 / v[i].norm();
  const MatrixXd by =
      ridge_inverse(weights.asDiagonal() * values_of<kInsideFields>(inside_ways(), v)) *
      weights.asDiagonal();
  return by.transpose();
}

}  // namespace hapsim
