#include "recording/contradictions.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "recording/force_noise.h"

namespace hapsim {

std::string other_radius_words(const Metadata& metadata, double radius, const std::string& name) {
  constexpr double kSame = 1e-3;  // relative
  const double own = metadata.number("tool_radius", name).value_or(radius);
  if (!(own > 0) || std::abs(radius - own) < kSame * own) return "";
  return fmt::format(
      "{} says tool_radius {:g} m, and {:g} m is taken instead, {:.3g} times that: E comes out "
      "wrong by about as much if the file is right",
      name, own, radius, radius / own);
}

std::string other_noise_words(const Recording& recording, double noise, const std::string& what) {
  constexpr double kPlain = 10;
  if (recording.f.empty()) return "";
  double squares = 0;
  for (const Vec3& f : recording.f) squares += f.squaredNorm();
  const double rms = std::sqrt(squares / (3.0 * static_cast<double>(recording.f.size())));
  if (noise > rms && rms > 0)
    fail_usage(fmt::format("{} is {:g} N, and the forces of {} are {:.3g} N (rms)", what, noise,
                           recording.name, rms),
               "nothing could be told from them; give the noise of one component, as 10mN");
  const double scatter = measure_force_noise(recording).sigma;
  if (!(scatter > 0) || (noise < kPlain * scatter && scatter < kPlain * noise)) return "";
  return fmt::format("{} is {:g} N, {:.2g} times what the samples scatter ({:.2g} N)", what, noise,
                     noise / scatter, scatter);
}

}  // namespace hapsim
