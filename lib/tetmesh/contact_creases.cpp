// Sharp edges in the surface about a contact: the graded triangles keep to them, for cutting one
// off makes the place softer.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

using Plane = Eigen::Vector2d;

constexpr double kStep = 0.125;   // of the creases' ways, in edge lengths at the rim
constexpr double kApart = 0.5;    // least distance of nodes from each other, rim and outline, in
constexpr double kOutline = 0.3;  // edge lengths

double size_at(const Grading& grading, double distance) {
  const auto& d = grading.distance;
  const auto k =
      static_cast<std::size_t>(std::upper_bound(d.begin(), d.end(), distance) - d.begin());
  if (k >= d.size()) return grading.size.back();
  const double t = (distance - d[k - 1]) / (d[k] - d[k - 1]);
  return grading.size[k - 1] + t * (grading.size[k] - grading.size[k - 1]);
}

}  // namespace

double CreaseNodes::distance(const Plane& p) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Plane& q : way) least = std::min(least, (p - q).squaredNorm());
  return std::sqrt(least);
}

CreaseNodes crease_nodes(const ContactRegion& region, double rim, const Grading& grading) {
  CreaseNodes result;
  const auto size = [&](const Plane& p) { return size_at(grading, std::abs(p.norm() - rim)); };
  const auto is_apart = [&](const Plane& p, const std::vector<Plane>& others, double least) {
    return std::all_of(others.begin(), others.end(),
                       [&](const Plane& q) { return (p - q).norm() >= least; });
  };
  std::vector<Plane> wished;
  for (const auto& [a, b] : region.plan.creases()) {
    const int steps =
        std::max(1, static_cast<int>(std::ceil((b - a).norm() / (kStep * grading.size[0]))));
    std::vector<Plane> way;
    for (int i = 0; i <= steps; ++i) way.push_back(region.plan.of(a + (b - a) * i / steps));
    std::vector<std::size_t> fixed{0};
    for (std::size_t i = 1; i < way.size(); ++i) {
      const double from = way[i - 1].norm() - rim, to = way[i].norm() - rim;
      if ((from > 0) == (to > 0)) continue;
      Plane p = way[i - 1] + from / (from - to) * (way[i] - way[i - 1]);
      p *= rim / p.norm();
      // A crease that only grazes the rim is not followed there.
      if (is_apart(p, result.on_rim, kApart * grading.size[0])) result.on_rim.push_back(p);
      fixed.push_back(std::abs(from) < std::abs(to) ? i - 1 : i);
    }
    fixed.push_back(way.size() - 1);
    for (std::size_t k = 0; k + 1 < fixed.size(); ++k) {
      std::vector<double> rows{0};
      for (std::size_t i = fixed[k]; i < fixed[k + 1]; ++i)
        rows.push_back(rows.back() +
                       (way[i + 1] - way[i]).norm() / size(0.5 * (way[i] + way[i + 1])));
      const int parts = std::max(1, static_cast<int>(std::lround(rows.back())));
      for (int j = 0; j <= parts; ++j) {
        const auto at = static_cast<std::size_t>(
            std::lower_bound(rows.begin(), rows.end(), rows.back() * j / parts * (1 - 1e-12)) -
            rows.begin());
        wished.push_back(way[fixed[k] + at]);
      }
    }
    result.way.insert(result.way.end(), way.begin(), way.end());
  }
  for (const Plane& p : wished) {
    const double h = size(p);
    if (std::abs(p.norm() - rim) >= kApart * h && is_apart(p, result.free, kApart * h) &&
        region.contains(p.x(), p.y(), kOutline * h))
      result.free.push_back(p);
  }
  return result;
}

}  // namespace hapsim
