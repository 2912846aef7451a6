// Foreign recordings with a known truth, as text: an organ probed by a robot, a machine on a block.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "base/vec3.h"
#include "import/import.h"

namespace hapsim::test {

// One touched place of an organ-like dome, in millimetres.
struct Site {
  Vec3 point, normal;
};

inline std::vector<Site> sites(int count, std::uint64_t seed = 3) {
  Random random(seed);
  std::vector<Site> all;
  for (int i = 0; i < count; ++i) {
    const double x = 60 * random.uniform() - 30, y = 60 * random.uniform() - 30;
    all.push_back({Vec3(100 + x, 20 + y, -50 - (x * x + y * y) / 200),
                   Vec3(x / 100, y / 100, 1).normalized()});
  }
  return all;
}

inline double organ_force(double depth_mm) {
  return 0.3 * depth_mm + 0.02 * depth_mm * depth_mm;
}

inline Vec3 noise(Random& random, double sigma) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sigma * Vec3(x, y, z);
}

inline std::string cells(const Vec3& v) {
  return fmt::format(",{:.5f},{:.5f},{:.5f}", v.x(), v.y(), v.z());
}

// Ten depths of 0.5 to 5 mm at each site; `row` writes one line (site number, site, depth in mm,
// force).
inline std::string organ(
    const std::string& header,
    const std::function<std::string(int, const Site&, double, const Vec3&)>& row, int count = 20) {
  Random random(5);
  std::string text = header + "\n";
  const std::vector<Site> all = sites(count);
  for (std::size_t s = 0; s < all.size(); ++s)
    for (int k = 1; k <= 10; ++k) {
      const double depth = 0.5 * k;
      const Vec3 force = organ_force(depth) * all[s].normal + noise(random, 0.01);
      text += row(static_cast<int>(s) + 1, all[s], depth, force) + "\n";
    }
  return text;
}

// A machine's ramp to `depth` [mm] and hold, after an approach of `air` [mm]; one Maxwell term, 5
// s.
struct Ramp {
  double air = 3, depth = 6, speed = 1, hold = 20, step = 0.05, bias = 0, sigma = 0.01, power = 1,
         stiffness = 0.4;
};

struct RampRow {
  double t, travel, force;  // [s], [mm], [N]
};

inline std::vector<RampRow> ramp(const Ramp& r, std::uint64_t seed = 7) {
  Random random(seed);
  std::vector<RampRow> rows;
  double memory = 0, before = 0;
  const int count = static_cast<int>(((r.air + r.depth) / r.speed + r.hold) / r.step);
  const double fade = std::exp(-r.step / 5);
  for (int i = 0; i < count; ++i) {
    const double t = i * r.step, travel = std::min(t * r.speed, r.air + r.depth);
    const double elastic = r.stiffness * std::pow(std::max(travel - r.air, 0.0), r.power);
    memory = fade * memory + (elastic - before) * 5 / r.step * (1 - fade);
    before = elastic;
    rows.push_back({t, travel, 0.6 * elastic + 0.4 * memory + r.bias + r.sigma * random.normal()});
  }
  return rows;
}

inline std::string replaced(std::string text, char from, char to) {
  for (char& c : text)
    if (c == from) c = to;
  return text;
}

inline ImportResult import_text(const std::string& text, const ImportOptions& options = {}) {
  Input input = Input::from_bytes(text, "data.csv");
  return import_recording(read_raw_table(input), options);
}

inline bool mentions(const std::vector<std::string>& lines, const std::string& text) {
  for (const std::string& line : lines)
    if (line.find(text) != line.npos) return true;
  return false;
}

}  // namespace hapsim::test
