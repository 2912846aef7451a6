#include "watch/online_identification.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "material/maxwell_memory.h"

namespace hapsim {

UnitResponse::UnitResponse(const PreparedBody& body, const std::vector<double>& times,
                           const ToolLoopOptions& options)
    : ToolLoop(&body.distance(), options), body_(body), times_(times) {
  assert(times.size() < static_cast<std::size_t>(kMostUnknowns));
  const auto unknowns = static_cast<Eigen::Index>(times.size() + 1);
  g_ = UnitForces::Zero(3, unknowns);
  moduli_ = ModuliVector::Zero(unknowns);
}

void UnitResponse::take_place(const Place& place) noexcept {
  K_ = body_.field().at(place.face, place.point);
}

Vec3 UnitResponse::advance(double t, const Vec3& u) noexcept {
  const Vec3 elastic = -(K_ * u);
  const double dt = t > t_ ? t - t_ : 0;
  g_.col(0) = elastic;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    auto h = g_.col(static_cast<Eigen::Index>(i + 1));
    if (!begun_) {
      h = elastic;
    } else {
      const MemoryStep s = memory_step(dt, times_[i]);
      h = s.a * h + s.c * (elastic - elastic_);
    }
  }
  elastic_ = elastic;
  if (!begun_ || t > t_) t_ = t;
  begun_ = true;
  return g_ * moduli_;
}

OnlineIdentification::OnlineIdentification(int unknowns, double memory)
    : unknowns_(unknowns), keep_(std::isinf(memory) ? 1 : std::exp(-1 / memory)) {
  assert(unknowns > 0 && unknowns <= kMostUnknowns);
  restart();
}

void OnlineIdentification::restart() noexcept {
  A_ = ModuliMatrix::Zero(unknowns_, unknowns_);
  b_ = ModuliVector::Zero(unknowns_);
  squares_ = weight_ = 0;
  samples_ = 0;
}

void OnlineIdentification::add(const UnitForces& unit, const Vec3& force) noexcept {
  if (!force.allFinite() || !unit.allFinite()) return;
  A_ = keep_ * A_ + unit.transpose() * unit;
  b_ = keep_ * b_ + unit.transpose() * force;
  squares_ = keep_ * squares_ + force.squaredNorm();
  weight_ = keep_ * weight_ + 3;
  ++samples_;
}

OnlineEstimate OnlineIdentification::estimate() const noexcept {
  OnlineEstimate result;
  result.samples = samples_;
  result.moduli = ModuliVector::Zero(unknowns_);
  result.error = ModuliVector::Constant(unknowns_, std::numeric_limits<double>::infinity());
  // Few unknowns: of all sets that may be above zero, the best whose solution is (what an active
  // set method searches). 63 small solutions at most.
  double best = squares_;
  unsigned chosen = 0;
  for (unsigned set = 1; set < (1U << unknowns_); ++set) {
    std::array<Eigen::Index, kMostUnknowns> index{};
    Eigen::Index count = 0;
    for (int i = 0; i < unknowns_; ++i)
      if (set >> i & 1U) index[static_cast<std::size_t>(count++)] = i;
    ModuliMatrix A(count, count);
    ModuliVector b(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      b[i] = b_[index[static_cast<std::size_t>(i)]];
      for (Eigen::Index j = 0; j < count; ++j)
        A(i, j) = A_(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]);
    }
    // Scaled to a unit diagonal; columns that are the same within rounding are no set.
    const ModuliVector scale = A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    A = scale.asDiagonal() * A * scale.asDiagonal();
    const Eigen::LDLT<ModuliMatrix> solved(A);
    if (solved.info() != Eigen::Success || solved.vectorD().minCoeff() < 1e-10) continue;
    const ModuliVector x = scale.cwiseProduct(solved.solve(scale.cwiseProduct(b)));
    if (x.minCoeff() < 0) continue;
    const double left = squares_ - x.dot(b);
    if (chosen != 0 && left >= best * (1 - 1e-12)) continue;
    best = left;
    chosen = set;
    const double freedom = std::max(weight_ - static_cast<double>(count), 1.0);
    const double variance = std::max(left, 0.0) / freedom;
    const ModuliMatrix inverse = solved.solve(ModuliMatrix::Identity(count, count));
    result.moduli.setZero();
    result.error.setConstant(std::numeric_limits<double>::infinity());
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index to = index[static_cast<std::size_t>(i)];
      result.moduli[to] = x[i];
      result.error[to] = scale[i] * std::sqrt(std::max(variance * inverse(i, i), 0.0));
    }
    result.rmse = std::sqrt(variance);
  }
  return result;
}

}  // namespace hapsim
