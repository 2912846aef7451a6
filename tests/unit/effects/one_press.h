// One press through one effect, for tests of closed forms.
#pragma once

#include <vector>

#include "effects/effects.h"

namespace hapsim::test {

constexpr double kStiffness = 200;  // [N/m]

inline PressView press_along(const std::vector<Vec3>& path) {
  PressView press;
  press.u = path;
  press.in_air.assign(path.size(), 0);
  press.radius = 0.004;
  press.modulus = 1e4;
  press.contact.modulus = 1e4;
  press.contact.K = kStiffness * Eigen::Matrix3d::Identity();
  return press;
}

// Depths below the surface, the tool along -z.
inline PressView press_to(const std::vector<double>& depths) {
  std::vector<Vec3> path;
  for (const double depth : depths) path.emplace_back(0, 0, -depth);
  return press_along(path);
}

// Forces of a spring of kStiffness in every direction after the effect.
inline std::vector<Vec3> forces_after(const Effect& effect, PressView press, const Values& values) {
  Motion motion{press.u, {}, 0};
  effect.move(press, values, motion);
  press.u = motion.u;
  Signal signal;
  signal.f.resize(3 * static_cast<Eigen::Index>(press.size()));
  for (std::size_t i = 0; i < press.size(); ++i)
    signal.f.segment<3>(3 * static_cast<Eigen::Index>(i)) = -kStiffness * press.u[i];
  signal.df.resize(signal.f.size(), 0);
  effect.apply(press, values, signal);
  std::vector<Vec3> f;
  for (std::size_t i = 0; i < press.size(); ++i)
    f.push_back(signal.f.segment<3>(3 * static_cast<Eigen::Index>(i)));
  return f;
}

}  // namespace hapsim::test
