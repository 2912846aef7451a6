#include "compare/error_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostFaces = 60000;

double diagonal(const Surface& surface) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& v : surface.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return (high - low).norm();
}

double default_reach(const Surface& surface, const std::vector<Vec3>& positions) {
  std::vector<double> nearest;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < positions.size(); ++j)
      if (i != j) best = std::min(best, (positions[i] - positions[j]).norm());
    nearest.push_back(best);
  }
  const double size = diagonal(surface);
  return std::clamp(1.5 * upper_median(std::move(nearest)), 0.02 * size, 0.15 * size);
}

// Halves every edge longer than `longest`. A triangle is split by which of its edges are halved, so
// neighbours agree and the surface stays closed.
Surface split_long_edges(const Surface& in, double longest) {
  Surface out{in.vertices, {}};
  std::map<std::pair<int, int>, int> middle;
  const auto split = [&](int a, int b) {
    if ((in.vertices[a] - in.vertices[b]).norm() <= longest) return -1;
    const auto [found, is_new] =
        middle.try_emplace(std::minmax(a, b), static_cast<int>(out.vertices.size()));
    if (is_new) out.vertices.push_back(0.5 * (in.vertices[a] + in.vertices[b]));
    return found->second;
  };
  for (const Triangle& f : in.faces) {
    std::array<int, 3> m{split(f[0], f[1]), split(f[1], f[2]), split(f[2], f[0])};
    const auto cuts = std::count_if(m.begin(), m.end(), [](int v) { return v >= 0; });
    if (cuts == 0) {
      out.faces.push_back(f);
      continue;
    }
    // Turned so that with one cut it is edge 0-1, with two cuts edge 2-0 is whole.
    int turn = 0;
    if (cuts == 1)
      while (m[turn] < 0) ++turn;
    if (cuts == 2)
      while (m[(turn + 2) % 3] >= 0) ++turn;
    const Triangle c{f[turn], f[(turn + 1) % 3], f[(turn + 2) % 3]};
    const std::array<int, 3> d{m[turn % 3], m[(turn + 1) % 3], m[(turn + 2) % 3]};
    if (cuts == 1) {
      out.faces.insert(out.faces.end(), {Triangle{c[0], d[0], c[2]}, Triangle{d[0], c[1], c[2]}});
    } else if (cuts == 2) {
      out.faces.insert(out.faces.end(), {Triangle{c[1], d[1], d[0]}, Triangle{c[0], d[0], d[1]},
                                         Triangle{c[0], d[1], c[2]}});
    } else {
      out.faces.insert(out.faces.end(), {Triangle{c[0], d[0], d[2]}, Triangle{d[0], c[1], d[1]},
                                         Triangle{d[2], d[1], c[2]}, Triangle{d[0], d[1], d[2]}});
    }
  }
  return out;
}

}  // namespace

ErrorMap map_error(const Surface& surface, const std::vector<Vec3>& positions,
                   const std::vector<double>& error, double reach) {
  ErrorMap map;
  map.reach = reach > 0 ? reach : default_reach(surface, positions);
  map.surface = surface;
  while (map.surface.faces.size() * 4 <= kMostFaces) {
    Surface finer = split_long_edges(map.surface, map.reach / 4);
    if (finer.faces.size() == map.surface.faces.size()) break;
    map.surface = std::move(finer);
  }
  const double core = 0.02 * map.reach;  // within it a position speaks alone
  for (const Vec3& v : map.surface.vertices) {
    double sum = 0, weights = 0, nearest = std::numeric_limits<double>::infinity(), its_error = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const double distance = (positions[i] - v).norm();
      if (distance < nearest) nearest = distance, its_error = error[i];
      if (distance >= map.reach) continue;
      const double weight = std::pow(1 / std::max(distance, core) - 1 / map.reach, 2);
      sum += weight * error[i];
      weights += weight;
    }
    map.error.push_back(weights > 0 ? sum / weights : its_error);
    map.distance.push_back(nearest);
  }
  return map;
}

}  // namespace hapsim
