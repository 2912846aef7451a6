// Closed analytic objects on a flat base z = 0, for tests and benchmarks [m].
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/surface.h"

namespace hapsim::test {

// The upper half of r(direction) about the origin, closed by the plane z = 0. A square grid of
// 2 `rings` cells a side is laid over top and base by the concentric map (Shirley and Chiu, J.
// Graphics Tools 2, 1997), so triangles are even and there is no pole.
inline Surface dome(const std::function<double(const Vec3&)>& radius, int rings) {
  Surface s;
  const int side = 2 * rings + 1;
  const auto polar = [&](int i, int j) {  // radius from 0 to 1, azimuth
    const double a = static_cast<double>(i) / rings - 1, b = static_cast<double>(j) / rings - 1;
    if (a == 0 && b == 0) return std::pair(0.0, 0.0);
    if (std::abs(a) > std::abs(b))
      return std::pair(std::abs(a), std::numbers::pi / 4 * (b / a) + (a < 0) * std::numbers::pi);
    return std::pair(std::abs(b), std::numbers::pi / 2 - std::numbers::pi / 4 * (a / b) +
                                      (b < 0) * std::numbers::pi);
  };
  std::vector<int> top(side * side), base(side * side);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const auto [r, azimuth] = polar(i, j);
      const bool rim = i == 0 || j == 0 || i == side - 1 || j == side - 1;
      const double elevation = rim ? 0 : 0.5 * std::numbers::pi * (1 - r);
      const Vec3 flat(std::cos(azimuth), std::sin(azimuth), 0);
      const Vec3 d = std::cos(elevation) * flat + std::sin(elevation) * Vec3::UnitZ();
      const int at = j * side + i;
      top[at] = static_cast<int>(s.vertices.size());
      s.vertices.push_back(radius(d) * d);
      base[at] = rim ? top[at] : static_cast<int>(s.vertices.size());
      if (!rim) s.vertices.push_back(r * radius(flat) * flat);
    }
  for (int j = 0; j + 1 < side; ++j)
    for (int i = 0; i + 1 < side; ++i) {
      const int a = j * side + i, b = a + 1, c = a + side + 1, d = a + side;
      // The diagonal that points outwards keeps the corners of the square from flat triangles.
      const bool forward = (i < rings) == (j < rings);
      const auto add = [&](int u, int v, int w) {
        s.faces.push_back({top[u], top[v], top[w]});
        s.faces.push_back({base[u], base[w], base[v]});
      };
      if (forward) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  return s;
}

// A half ball of 50 mm.
inline Surface half_ball(int rings = 14) {
  return dome([](const Vec3&) { return 0.05; }, rings);
}

// An uneven lump, 60 to 100 mm across, like an organ on a table.
inline Surface lump(int rings = 14) {
  return dome(
      [](const Vec3& d) {
        return 0.04 * (1 + 0.25 * d.x() + 0.18 * d.x() * d.y() +
                       0.12 * std::sin(3 * d.y() + d.z()) - 0.2 * d.z() * d.z());
      },
      rings);
}

}  // namespace hapsim::test
