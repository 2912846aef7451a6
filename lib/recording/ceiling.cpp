#include "recording/ceiling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hapsim {

std::array<Ceiling, 3> find_ceilings(const std::vector<Vec3>& forces) {
  constexpr double kExactly = 1e-6;
  std::array<Ceiling, 3> ceilings;
  for (int k = 0; k < 3; ++k) {
    Ceiling& c = ceilings[static_cast<std::size_t>(k)];
    for (const Vec3& f : forces) c.force = std::max(c.force, std::abs(f[k]));
    c.readings =
        static_cast<std::size_t>(std::count_if(forces.begin(), forces.end(), [&](const Vec3& f) {
          return std::abs(f[k]) >= (1 - kExactly) * c.force;
        }));
  }
  return ceilings;
}

std::string ceiling_words(const std::array<Ceiling, 3>& ceilings) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!ceilings[k].reached()) continue;
    text +=
        fmt::format("{}{} readings of {} are exactly {:.4g} N in size, the largest",
                    text.empty() ? "" : "; ", ceilings[k].readings, "xyz"[k], ceilings[k].force);
  }
  return text;
}

}  // namespace hapsim
