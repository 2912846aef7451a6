// A flat tool that slips on a body of finite strain: rings that slip (rim_slip.h) under the held
// response, with what the body remembers.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "realtime/force_loop.h"

namespace hapsim {
namespace {

constexpr double kSlippedFar = 0.5;  // tool radii, from which on the contact is elsewhere
constexpr double kSeenAll = 0.95;    // of mu N sideways: then it was seen to slip as a whole

// Two ways along the surface, each rows of one: the same for the same normal.
Eigen::Matrix<double, 2, 3> along_surface(const Vec3& n) noexcept {
  int least = 0;
  n.cwiseAbs().minCoeff(&least);
  const Vec3 first = n.cross(Vec3::Unit(least)).normalized();
  Eigen::Matrix<double, 2, 3> ways;
  ways << first.transpose(), n.cross(first).transpose();
  return ways;
}

}  // namespace

LargeStrain::Force ForceLoop::slide(const StepSample& sample, const Vec3& u) noexcept {
  const LargeStrain& strain = *body_.large_strain();
  const StrainSlip& law = *strain.slip();
  const double a = body_.tool_radius();
  const Vec3& n = state_.place.normal;
  const Eigen::Matrix<double, 2, 3> ways = along_surface(n);
  double* const memory = state_.memory.data() + slip_memory_;
  if (sample.first || sample.in_air) std::fill_n(memory, RimSlip::kNumbers, 0.0);
  Eigen::Map<Eigen::Matrix<double, 2, RimSlip::kParts>> slip(memory);
  Eigen::Map<Eigen::Vector2d> held_at(memory + 2 * RimSlip::kParts);
  RimSlip::State state{slip, held_at};
  const double d = -u.dot(n) / a;
  double* const remembered = state_.memory.data() + strain_memory_;
  std::copy_n(remembered, before_.size(), before_.data());
  LargeStrain::Force held;
  int asked = 0;
  const RimSlip::Force f = law.rim.step(d, ways * u / a, state, [&](const Eigen::Vector2d& way) {
    if (asked++ > 0) std::copy_n(before_.data(), before_.size(), remembered);
    const Vec3 at = a * (ways.transpose() * way) - a * d * n;
    held = strained(sample, at);
    Eigen::Matrix3d K = a * strain.tangent(strain_, at);
    if (strain.remembers()) {
      // A body that relaxes is as much stiffer than at rest sideways as it is along the normal.
      const double still = -n.dot(strain.force(strain_, at).f);
      if (still > 0) K *= std::clamp(-n.dot(held.f) / still, 1.0, 10.0);
    }
    return RimHeld{-n.dot(held.f), ways * held.f, -ways * (K * n), ways * K * ways.transpose()};
  });
  slip = state.slip;
  held_at = state.way;
  const double size = held.f.norm();
  held.f = ways.transpose() * f.along - f.normal * n;
  if (held.f.norm() > 0) held.doubt = std::hypot(held.doubt * size / held.f.norm(), law.doubt);
  // Beyond what was seen of this tool.
  const bool seen =
      law.seen >= kSeenAll || f.along.norm() <= law.seen * law.rim.friction * f.normal;
  if (!seen || d > law.deepest || f.slipped.norm() > kSlippedFar) held.within = false;
  return held;
}

}  // namespace hapsim
