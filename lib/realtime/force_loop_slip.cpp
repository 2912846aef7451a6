// A flat tool that slips on a body of finite strain: rings that slip (rim_slip.h) under the held
// response, with what the body remembers.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "realtime/force_loop.h"

namespace hapsim {
namespace {

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
  StrainSlip::State state;
  if (!sample.first && !sample.in_air) state = StrainSlip::State::load(memory);
  const double d = -u.dot(n) / a;
  double* const remembered = state_.memory.data() + strain_memory_;
  std::copy_n(remembered, before_.size(), before_.data());
  LargeStrain::Force held;
  int asked = 0;
  const RimSlip::Force f = law.step(d, ways * u / a, state, [&](const Eigen::Vector2d& way) {
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
  state.store(memory);
  const Vec3 holds = held.f;
  held.f = ways.transpose() * f.along - f.normal * n;
  const double size = held.f.norm();
  if (size > 0)
    held.doubt = std::hypot(held.doubt * holds.norm() / size,
                            law.doubt_of(state, (held.f - holds).norm() / size));
  if (!law.within(state, f)) held.within = false;
  return held;
}

}  // namespace hapsim
