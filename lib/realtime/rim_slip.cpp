#include "realtime/rim_slip.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapsim {
namespace {

constexpr int kSectors = RimSlip::kSectors;
constexpr int kSweeps = 12;
constexpr double kSettled = 1e-5;  // of the tool's radius: what a sweep still slips

std::array<Eigen::Vector2d, kSectors> directions() {
  std::array<Eigen::Vector2d, kSectors> all;
  for (int k = 0; k < kSectors; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSectors;
    all[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
  }
  return all;
}

Eigen::Index part(std::size_t ring, std::size_t sector) {
  return static_cast<Eigen::Index>(ring * kSectors + sector);
}

}  // namespace

double RimSlip::returns_at(double depth) const noexcept {
  const double at = std::clamp(depth / kReturnStep, 0.0, kReturns - 1.0);
  const auto below = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kReturns - 2));
  return returns[below] + (at - static_cast<double>(below)) * (returns[below + 1] - returns[below]);
}

RimSlip::Force RimSlip::settle(double depth, const Eigen::Vector2d& aside, const RimHeld& held,
                               State& state) const noexcept {
  static const std::array<Eigen::Vector2d, kSectors> kDirection = directions();
  const Eigen::Vector2d about = state.way;
  const double k = std::max(0.5 * held.stiffness.trace(), 1e-12);
  // A body that is hardly stable sideways has no inverse to go by.
  const bool firm = held.stiffness.determinant() > 1e-3 * k * k;
  const Eigen::Matrix2d K =
      firm ? held.stiffness : Eigen::Matrix2d(k * Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d give = K.inverse();
  const Eigen::Vector2d there = held.along + K * (aside - about);  // of a part that has not slipped
  const double returning = returns_at(depth);
  double normal = std::max(held.normal, 0.0);
  Force force;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most_slipped = 0, lost = 0;
    force.along.setZero();
    force.slipped.setZero();
    for (std::size_t j = 0; j < kRings; ++j) {
      const double w = kWeight[j] / kSectors;
      const double inwards = (drawn[j] + drawn_more[j] * depth) * depth;
      const double by_depth = drawn[j] + 2 * drawn_more[j] * depth;
      const double most = friction * normal * bound[j] * w;
      const double inner = j > 0 ? between[j - 1] * k / kSectors : 0,
                   outer = j + 1 < kRings ? between[j] * k / kSectors : 0, beside = around * w * k;
      const double stiff = w * k + inner + outer + 2 * beside;
      for (std::size_t s = 0; s < kSectors; ++s) {
        const Eigen::Vector2d& r = kDirection[s];
        auto slip = state.slip.col(part(j, s));
        Eigen::Vector2d q = w * (there + K * (inwards * r - slip));
        if (j > 0) q -= inner * (slip - state.slip.col(part(j - 1, s)));
        if (j + 1 < kRings) q -= outer * (slip - state.slip.col(part(j + 1, s)));
        q -= beside * (2 * slip - state.slip.col(part(j, (s + 1) % kSectors)) -
                       state.slip.col(part(j, (s + kSectors - 1) % kSectors)));
        const double size = q.norm();
        if (size > most) {
          const double slips = (size - most) / stiff;
          slip += (slips / size) * q;
          most_slipped = std::max(most_slipped, slips);
        }
        force.along += w * (there + K * (inwards * r - slip));
        force.slipped += w * slip;
        lost += w * by_depth * r.dot(slip);
      }
    }
    state.way = about + give * (force.along - held.along);
    const double was = normal;
    normal =
        std::max(0.0, held.normal + held.couples.dot(state.way - about) - returning * k * lost);
    if (most_slipped <= kSettled && std::abs(normal - was) <= 1e-4 * normal) break;
  }
  force.normal = normal;
  const double size = force.along.norm(), most = friction * normal;
  if (size > most) force.along *= most / size;
  return force;
}

}  // namespace hapsim
