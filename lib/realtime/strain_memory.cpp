#include "realtime/strain_memory.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "realtime/strain_sample.h"

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
// Where the surface is about to fold, the tangent is nearly singular, and the derivatives by v of
// one state may be hundreds of times what the others' are: how large they may be over the force
// over its way before they count for less.
constexpr double kMemorySteep = 8;

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
double aside_weight(const Vec3& v, double aside) {
  const double share = std::hypot(v[1], v[2]) / strain_side(v[0], aside);
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

StressStates::StressStates(const Eigen::Matrix3d& frame, double radius, double unit,
                           std::vector<Vec3> v, double aside)
    : frame_(frame), radius_(radius), unit_(unit), aside_(aside), v_(std::move(v)) {
  const auto n = static_cast<Index>(v_.size());
  forces_ = MatrixXd::Zero(3 * n, 4 * n);
  works_ = MatrixXd::Zero(n, n);
}

void StressStates::add(const std::function<StressResponse(std::size_t state)>& of) {
  const auto n = static_cast<Index>(v_.size());
  Eigen::MatrixXf stress, all, work, strain, inside_work, inside_changes;  // numbers x states
  for (Index i = 0; i < n; ++i) {
    const StressResponse response = of(static_cast<std::size_t>(i));
    const Index numbers = response.stress.size(), fields = response.inside_work.cols();
    if (i == 0) {
      stress.resize(numbers, n);
      strain.resize(numbers, n);
      all.resize(numbers, 4 * n);
      work.resize(numbers, 3 * n);
      inside_work.resize(numbers, fields * n);
      inside_changes.resize(numbers, fields * n);
    }
    stress.col(i) = response.stress.cast<float>();
    strain.col(i) = response.strain.cast<float>();
    all.col(4 * i) = stress.col(i);
    all.middleCols<3>(4 * i + 1) = (radius_ * response.changes * frame_.transpose()).cast<float>();
    work.middleCols<3>(3 * i) = (response.work * frame_.transpose()).cast<float>();
    if (fields == 0) continue;
    inside_work.middleCols(fields * i, fields) = response.inside_work.cast<float>();
    inside_changes.middleCols(fields * i, fields) = response.inside_changes.cast<float>();
    stiffness_.resize(v_.size(), Eigen::Matrix<double, kInsideFields, kInsideFields>::Zero());
    stressed_.resize(v_.size(), Eigen::Matrix<double, kInsideFields, kInsideFields>::Zero());
    stiffness_[static_cast<std::size_t>(i)] +=
        response.inside_changes.transpose() * response.inside_work / unit_;
    if (response.inside_stressed.size() > 0)
      stressed_[static_cast<std::size_t>(i)] += response.inside_stressed / unit_;
  }
  forces_ += (radius_ / unit_) * (work.transpose() * all).cast<double>();
  works_ += (strain.transpose() * stress).cast<double>() / unit_;
  if (stiffness_.empty()) return;
  if (inside_works_.size() == 0)
    inside_works_ = inside_done_ = MatrixXd::Zero(inside_work.cols(), n);
  inside_works_ += (inside_work.transpose() * stress).cast<double>() / unit_;
  inside_done_ += (inside_changes.transpose() * strain).cast<double>() / unit_;
}

StrainMemory StressStates::fit(double& error) const {
  const auto n = static_cast<Index>(v_.size());
  const MatrixXd& F = forces_;
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
    const double steep = F.block<3, 3>(3 * i, 4 * i + 1).norm() * v.norm() /
                         std::max(size[i], std::numeric_limits<double>::min());
    const double pin = v.isZero(0)            ? kMemoryPin
                       : steep > kMemorySteep ? std::pow(kMemorySteep / steep, 2)
                                              : 1;
    columns[4 * i] = values[i] = aside_weight(v, aside_) / std::max(size[i], floor);
    rows.segment<3>(3 * i).setConstant(pin * values[i]);
    columns.segment<3>(4 * i + 1).setConstant(pin * kMemorySlope * columns[4 * i]);
  }
  const MatrixXd left = ridge_inverse(rows.asDiagonal() * now) * rows.asDiagonal(),
                 right = ridge_inverse(columns.asDiagonal() * before) * columns.asDiagonal();
  StrainMemory memory;
  memory.C = left * F * right.transpose();
  if (!stiffness_.empty()) fit_inside(values, memory.inside);
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
  for (std::size_t i = 0; i < states; ++i) {
    const auto row = static_cast<Index>(i);
    const MatrixXd g = inside_works_.middleRows<kInsideFields>(kInsideFields * row) *
                       right.transpose(),
                   w = inside_done_.middleRows<kInsideFields>(kInsideFields * row) *
                       right.transpose();
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
