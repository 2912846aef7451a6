#include "calibrate/given_gravity.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {

std::optional<Vec3> given_gravity(const std::string& text, const std::string& what) {
  if (text == "estimate") return std::nullopt;
  Vec3 g;
  std::size_t from = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    if (from > text.size() || !parse_number(std::string_view(text).substr(from, to - from), g[k]) ||
        (to == text.size()) != (k == 2))
      fail_usage(what + ": " + shown(text) + " is not three numbers",
                 "write for example 0,0,-9.81, or estimate");
    from = to + 1;
  }
  constexpr double kMoon = 1.5, kJupiter = 25;  // [m/s2]
  if (g.norm() < kMoon || g.norm() > kJupiter)
    fail_usage(fmt::format("{}: gravity is {:.4g} m/s2 there", what, g.norm()),
               "give it with its size: 0,0,-9.81");
  return g;
}

}  // namespace hapsim
