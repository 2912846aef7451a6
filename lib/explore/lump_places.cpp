#include "explore/lump_places.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

using Row = Eigen::Matrix<double, 5, 1>;  // derivatives by the centre, log A and the common gain
using Information = Eigen::Matrix<double, 5, 5>;

constexpr double kVagueCentre = 0.02;  // [m] standard deviation before all presses
constexpr double kVagueLog = 2;
constexpr double kApart = 0.5;  // tool radii from what was pressed: nearer says the same again

struct SmallLump {
  double value;
  Vec3 by_centre;
};

SmallLump signal_at(const Vec3& point, const Vec3& normal, const Vec3& centre, double radius) {
  const Vec3 r = centre - point;
  const double z = -r.dot(normal), d = r.squaredNorm() + radius * radius;
  const double value = z * z / (d * d * d);
  return {value, Vec3(-2 * z * normal / (d * d * d) - 6 * value / d * r)};
}

// The factor of the signal by the gains, beside what they have in common.
double size_of(const std::vector<SeenPlace>& seen, const std::vector<double>& signal) {
  double n = 0, g = 0, s = 0, gs = 0, ss = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (!std::isfinite(seen[k].gain)) continue;
    n += 1, g += seen[k].gain, s += signal[k];
    gs += seen[k].gain * signal[k], ss += signal[k] * signal[k];
  }
  const double variance = ss - s * s / std::max(n, 1.0);
  return variance > 0 ? (gs - g * s / n) / variance : 0;
}

Row row_of(const SmallLump& signal, double size) {
  Row row;
  row << size * signal.by_centre, size * signal.value, 1;
  return row;
}

// The surface under a place looks as its nearest candidate does.
Vec3 normal_near(const std::vector<PressablePlace>& places, const Vec3& p) {
  return std::min_element(places.begin(), places.end(),
                          [&](const PressablePlace& a, const PressablePlace& b) {
                            return (a.point - p).squaredNorm() < (b.point - p).squaredNorm();
                          })
      ->normal;
}

}  // namespace

std::vector<PressablePlace> lump_places(const std::vector<PressablePlace>& places,
                                        const std::vector<SeenPlace>& seen, const Lump& lump,
                                        double tool_radius, double error, std::size_t count) {
  std::vector<PressablePlace> chosen;
  if (places.empty()) return chosen;
  std::vector<SmallLump> at_seen;
  std::vector<double> values;
  for (const SeenPlace& s : seen) {
    at_seen.push_back(signal_at(s.point, normal_near(places, s.point), lump.centre, tool_radius));
    values.push_back(at_seen.back().value);
  }
  const double size = size_of(seen, values);
  Information known = Information::Zero();
  known.diagonal() << Vec3::Constant(1 / (kVagueCentre * kVagueCentre)),
      1 / (kVagueLog * kVagueLog), 1e-6;
  const auto add = [&](Information& H, const Row& row) {
    H += row * row.transpose() / (error * error);
  };
  for (const SmallLump& s : at_seen) add(known, row_of(s, size));
  std::vector<bool> taken(places.size(), false);
  const auto too_near = [&](const Vec3& p, const Vec3& other) {
    return (p - other).norm() < kApart * tool_radius;
  };
  for (std::size_t k = 0; k < places.size(); ++k)
    taken[k] = std::any_of(seen.begin(), seen.end(),
                           [&](const SeenPlace& s) { return too_near(places[k].point, s.point); });
  while (chosen.size() < count) {
    std::size_t best = places.size();
    double least = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (taken[k]) continue;
      Information with = known;
      add(with,
          row_of(signal_at(places[k].point, places[k].normal, lump.centre, tool_radius), size));
      const double spread =
          with.ldlt().solve(Information::Identity()).topLeftCorner<3, 3>().trace();
      if (best == places.size() || spread < least) best = k, least = spread;
    }
    if (best == places.size()) break;
    const PressablePlace& place = places[best];
    add(known, row_of(signal_at(place.point, place.normal, lump.centre, tool_radius), size));
    chosen.push_back(place);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (too_near(places[k].point, place.point)) taken[k] = true;
  }
  return chosen;
}

}  // namespace hapsim
