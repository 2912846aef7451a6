// Presses whose error is known.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "base/random.h"
#include "recording/recording.h"

namespace hapsim {

struct Synthetic {
  Recording measured;
  std::vector<Vec3> simulated;
};

// What the simulated force is made of besides the truth: measured = gain(row) * simulated + offset.
struct RowState {
  int press, position;
  double t, session, depth;  // [s], [m]
};

// `presses` ramps and holds on `positions` points of a dome: 0.5 s down to 1-5 mm, 1.5 s held, 0.25
// s up, 50 rows a second, 200 N/m, noise in every component.
inline Synthetic synthetic(int presses, int positions, double noise, std::uint64_t seed,
                           const std::function<double(const RowState&)>& gain = {},
                           const std::function<Vec3(const RowState&)>& offset = {}) {
  Random random(seed);
  Synthetic s;
  s.measured.name = "synthetic";
  s.measured.metadata.set("tool_radius", "0.004");
  s.measured.metadata.set("force_noise", std::to_string(noise));
  for (int p = 0; p < presses; ++p) {
    const int at = p % positions;
    const double angle = 2.4 * at, tilt = 0.1 * (at % 7);
    const Vec3 normal(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle),
                      std::cos(tilt));
    const double peak = 0.001 * (1 + random.integer(5));
    for (int i = 0; i <= 112; ++i) {
      const double t = 0.02 * i;
      const double depth = peak * (t < 0.5 ? t / 0.5
                                   : t < 2 ? 1
                                           : std::max(0.0, (2.25 - t) / 0.25));
      const RowState state{p, at, t, 30.0 * p + t, depth};
      const Vec3 force = 200 * depth * normal;
      Vec3 f = (gain ? gain(state) : 1) * force;
      if (offset) f += offset(state);
      for (int k = 0; k < 3; ++k) f[k] += noise * random.normal();
      s.measured.press.push_back(p + 1);
      s.measured.t.push_back(state.session);
      s.measured.line.push_back(static_cast<long>(s.measured.line.size()) + 3);
      s.measured.position.push_back(0.05 * normal);
      s.measured.u.push_back(-depth * normal);
      s.measured.f.push_back(f);
      s.simulated.push_back(force);
    }
  }
  return s;
}

}  // namespace hapsim
