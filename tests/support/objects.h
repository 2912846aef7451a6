// Closed analytic objects on a flat base z = 0, for tests and benchmarks [m].
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "geometry/surface.h"

namespace hapsim::test {

// The upper half of r(direction) about the origin, closed by the plane z = 0. `rings` rows of
// triangles from the rim to the top; the base has as many.
inline Surface dome(const std::function<double(const Vec3&)>& radius, int rings) {
  Surface s;
  const int around = 4 * rings;
  const auto direction = [&](int ring, int i) {
    const double elevation = 0.5 * std::numbers::pi * ring / rings;
    const double azimuth = 2 * std::numbers::pi * i / around;
    return Vec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      Vec3 d = direction(ring, i);
      if (ring == 0) d.z() = 0;
      s.vertices.push_back(radius(d) * d);
    }
  const int top = static_cast<int>(s.vertices.size());
  s.vertices.push_back(radius(Vec3::UnitZ()) * Vec3::UnitZ());
  const auto strip = [&](const std::function<int(int, int)>& at, int rows, int apex, bool up) {
    const auto add = [&](int a, int b, int c) {
      s.faces.push_back(up ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    for (int row = 0; row < rows; ++row)
      for (int i = 0; i < around; ++i) {
        const int a = at(row, i), b = at(row, (i + 1) % around);
        if (row + 1 == rows) {
          add(a, b, apex);
        } else {
          add(a, b, at(row + 1, (i + 1) % around));
          add(a, at(row + 1, (i + 1) % around), at(row + 1, i));
        }
      }
  };
  strip([&](int row, int i) { return row * around + i; }, rings, top, true);
  const int base = static_cast<int>(s.vertices.size());
  for (int row = 1; row < rings; ++row)
    for (int i = 0; i < around; ++i)
      s.vertices.push_back(s.vertices[i] * (1 - static_cast<double>(row) / rings));
  const int middle = static_cast<int>(s.vertices.size());
  s.vertices.emplace_back(0, 0, 0);
  strip([&](int row, int i) { return row == 0 ? i : base + (row - 1) * around + i; }, rings, middle,
        false);
  return s;
}

// A half ball of 50 mm.
inline Surface half_ball(int rings = 24) {
  return dome([](const Vec3&) { return 0.05; }, rings);
}

// An uneven lump, 60 to 100 mm across, like an organ on a table.
inline Surface lump(int rings = 24) {
  return dome(
      [](const Vec3& d) {
        return 0.04 * (1 + 0.25 * d.x() + 0.18 * d.x() * d.y() + 0.12 * std::sin(3 * d.y() + d.z()) -
                       0.2 * d.z() * d.z());
      },
      rings);
}

}  // namespace hapsim::test
