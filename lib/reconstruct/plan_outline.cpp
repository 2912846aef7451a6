#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "mesh/point_index.h"
#include "reconstruct/plan_window.h"

namespace hapsim {
namespace {

// Values at the nodes of a regular grid.
struct Grid {
  int nx = 0, ny = 0;
  double cell = 0;
  Vec2 origin = Vec2::Zero();
  std::vector<double> value;
  double& at(int i, int j) { return value[static_cast<std::size_t>(j) * nx + i]; }
  double at(int i, int j) const { return value[static_cast<std::size_t>(j) * nx + i]; }
  Vec2 place(double i, double j) const { return origin + cell * Vec2(i, j); }
};

Grid grid_about(const std::vector<Vec3>& flat, double margin, double cell) {
  Vec3 low = flat.front(), high = flat.front();
  for (const Vec3& p : flat) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Grid grid;
  grid.cell = cell;
  grid.origin = low.head<2>().array() - margin;
  const Vec2 size = high.head<2>() - low.head<2>();
  grid.nx = static_cast<int>(std::ceil((size.x() + 2 * margin) / cell)) + 1;
  grid.ny = static_cast<int>(std::ceil((size.y() + 2 * margin) / cell)) + 1;
  grid.value.assign(static_cast<std::size_t>(grid.nx) * grid.ny, 0);
  return grid;
}

constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

// Labels nodes for which `inside` is equal and which touch; returns the size of each label.
std::vector<int> label(const Grid& grid, const std::vector<char>& inside, std::vector<int>& name) {
  name.assign(grid.value.size(), -1);
  std::vector<int> size;
  for (std::size_t seed = 0; seed < name.size(); ++seed) {
    if (name[seed] >= 0) continue;
    std::vector<std::size_t> open{seed};
    name[seed] = static_cast<int>(size.size());
    size.push_back(0);
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      ++size.back();
      const int i = static_cast<int>(at) % grid.nx, j = static_cast<int>(at) / grid.nx;
      for (const auto& [di, dj] : kSides) {
        if (i + di < 0 || j + dj < 0 || i + di >= grid.nx || j + dj >= grid.ny) continue;
        const std::size_t to = at + di + static_cast<std::ptrdiff_t>(dj) * grid.nx;
        if (name[to] >= 0 || inside[to] != inside[at]) continue;
        name[to] = name[at];
        open.push_back(to);
      }
    }
  }
  return size;
}

// The largest part of the mask, with its holes filled. The corner of the grid lies outside.
void keep_largest(const Grid& grid, std::vector<char>& inside) {
  std::vector<int> name;
  std::vector<int> size = label(grid, inside, name);
  for (std::size_t n = 0; n < name.size(); ++n) {
    if (!inside[n]) size[name[n]] = 0;
  }
  const int best = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t n = 0; n < name.size(); ++n) inside[n] = name[n] == best;
  label(grid, inside, name);
  const int outside = name[0];
  for (std::size_t n = 0; n < name.size(); ++n) inside[n] = name[n] != outside;
}

// Rows, then columns of [1 2 1] / 4.
void blur(Grid& grid, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (const int step : {1, grid.nx}) {
      const std::vector<double> old = grid.value;
      for (int j = 1; j + 1 < grid.ny; ++j) {
        for (int i = 1; i + 1 < grid.nx; ++i) {
          const std::size_t n = static_cast<std::size_t>(j) * grid.nx + i;
          grid.value[n] = (old[n - step] + 2 * old[n] + old[n + step]) / 4;
        }
      }
    }
  }
}

// Moves the zero line outwards by so much.
void widen(Grid& grid, double beyond) {
  std::vector<Vec3> inside;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      if (const Vec2 p = grid.place(i, j); grid.at(i, j) > 0) inside.emplace_back(p.x(), p.y(), 0);
  if (inside.empty()) return;
  const PointIndex index(inside);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 p = grid.place(i, j);
      const double off = index.nearest({p.x(), p.y(), 0}, 1).front().distance;
      grid.at(i, j) = beyond + (off > 0 ? -off : std::max(0.0, grid.at(i, j)));
    }
}

// Zero line of the grid, the longest, with positive values on its left (marching triangles: each
// square cut along one diagonal leaves no ambiguous case).
std::vector<Vec2> zero_line(const Grid& grid) {
  using Key = std::pair<int, int>;  // the grid edge that is crossed, by its nodes
  std::map<Key, Key> next;
  std::map<Key, Vec2> place;
  const auto node = [&](int i, int j) { return j * grid.nx + i; };
  const auto cross = [&](int a, int b) {
    const Key key(std::min(a, b), std::max(a, b));
    const double va = grid.value[key.first], vb = grid.value[key.second];
    const Vec2 pa = grid.place(key.first % grid.nx, key.first / grid.nx);
    const Vec2 pb = grid.place(key.second % grid.nx, key.second / grid.nx);
    place.try_emplace(key, pa + (pb - pa) * (va / (va - vb)));
    return key;
  };
  for (int j = 0; j + 1 < grid.ny; ++j) {
    for (int i = 0; i + 1 < grid.nx; ++i) {
      const std::array<std::array<int, 3>, 2> triangles{
          {{node(i, j), node(i + 1, j), node(i + 1, j + 1)},
           {node(i, j), node(i + 1, j + 1), node(i, j + 1)}}};
      for (const auto& t : triangles) {
        for (int k = 0; k < 3; ++k) {
          const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
          const bool ia = grid.value[a] > 0, ib = grid.value[b] > 0, ic = grid.value[c] > 0;
          if (ia && !ib && !ic) next[cross(a, b)] = cross(c, a);
          if (!ia && ib && ic) next[cross(c, a)] = cross(a, b);
        }
      }
    }
  }
  std::vector<Vec2> longest;
  while (!next.empty()) {
    std::vector<Vec2> line;
    Key at = next.begin()->first;
    for (auto found = next.find(at); found != next.end(); found = next.find(at)) {
      line.push_back(place.at(at));
      at = found->second;
      next.erase(found);
    }
    if (line.size() > longest.size()) longest = std::move(line);
  }
  return longest;
}

double signed_area(const std::vector<Vec2>& line) {
  double sum = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2& a = line[i];
    const Vec2& b = line[(i + 1) % line.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / 2;
}

// Points at equal distances along the closed line.
std::vector<Vec2> resampled(const std::vector<Vec2>& line, double edge) {
  double length = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    length += (line[(i + 1) % line.size()] - line[i]).norm();
  }
  const int count = std::max(8, static_cast<int>(std::lround(length / edge)));
  std::vector<Vec2> even;
  double walked = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2 side = line[(i + 1) % line.size()] - line[i];
    const double step = side.norm();
    while (static_cast<int>(even.size()) < count) {
      const double target = length * static_cast<double>(even.size()) / count;
      if (target > walked + step) break;
      even.push_back(line[i] + side * (step > 0 ? (target - walked) / step : 0));
    }
    walked += step;
  }
  return even;
}

}  // namespace

std::vector<Vec2> plan_outline(const std::vector<Vec3>& points, double reach, double edge) {
  return outline_beyond(points, reach, edge, 0);
}

std::vector<Vec2> outline_beyond(const std::vector<Vec3>& points, double reach, double edge,
                                 double beyond) {
  std::vector<Vec3> flat = points;
  for (Vec3& p : flat) p.z() = 0;
  const PointIndex index(flat);
  Grid grid = grid_about(flat, 2 * reach + beyond, reach / 5);

  // All within reach of a point, then back by the same reach from what is outside.
  std::vector<char> inside(grid.value.size());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 p = grid.place(i, j);
      inside[static_cast<std::size_t>(j) * grid.nx + i] =
          index.nearest({p.x(), p.y(), 0}, 1).front().distance < reach;
    }
  }
  keep_largest(grid, inside);
  std::vector<Vec3> outside;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 p = grid.place(i, j);
      if (!inside[static_cast<std::size_t>(j) * grid.nx + i]) outside.emplace_back(p.x(), p.y(), 0);
    }
  }
  const PointIndex far(outside);
  std::vector<char> body(grid.value.size());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 p = grid.place(i, j);
      grid.at(i, j) = far.nearest({p.x(), p.y(), 0}, 1).front().distance - reach;
      body[static_cast<std::size_t>(j) * grid.nx + i] = grid.at(i, j) > 0;
    }
  }
  keep_largest(grid, body);
  for (std::size_t n = 0; n < body.size(); ++n) {
    if (body[n] != (grid.value[n] > 0)) grid.value[n] = body[n] ? grid.cell : -grid.cell;
  }
  if (beyond > 0) widen(grid, beyond);
  blur(grid, 4);
  std::vector<Vec2> line = zero_line(grid);
  if (line.size() < 8) {
    fail_input("", "the points have no area in plan view", "give --up, or more points");
  }
  if (signed_area(line) < 0) std::reverse(line.begin(), line.end());
  return resampled(line, edge);
}

}  // namespace hapsim
