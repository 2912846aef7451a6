// What must hold before a surface may reach TetGen.
#include "mesh/surface_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>

#include "base/error.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "run hs-reconstruct to get a closed clean surface";

std::string place(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

double diagonal(const Surface& surface) {
  Vec3 low = surface.vertices[0], high = low;
  for (const Vec3& p : surface.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

void check_numbers(const Surface& surface, const std::string& where) {
  if (surface.faces.empty())
    fail_input(where, "the surface has no triangle", "give a closed triangle surface");
  const int n = static_cast<int>(surface.vertices.size());
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    for (const int v : surface.faces[i])
      if (v < 0 || v >= n)
        fail_input(where, fmt::format("triangle {}: vertex {} is out of range", i, v), kMend);
  for (int i = 0; i < n; ++i)
    if (!surface.vertices[i].allFinite())
      fail_input(where, fmt::format("vertex {} is not finite", i), kMend);
}

// Sorted by x, so that only neighbours in x are compared.
void check_doubled(const Surface& surface, double tolerance, const std::string& where) {
  std::vector<int> order(surface.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return surface.vertices[a].x() < surface.vertices[b].x(); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3& p = surface.vertices[order[i]];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const Vec3& q = surface.vertices[order[k]];
      if (q.x() - p.x() > tolerance) break;
      if ((p - q).norm() <= tolerance)
        fail_input(where,
                   fmt::format("vertices {} and {} are both at {}", std::min(order[i], order[k]),
                               std::max(order[i], order[k]), place(p)),
                   kMend);
    }
  }
}

void check_flat(const Surface& surface, double size, const std::string& where) {
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const Triangle& f = surface.faces[i];
    const Vec3 &a = surface.vertices[f[0]], &b = surface.vertices[f[1]],
               &c = surface.vertices[f[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!((b - a).cross(c - a).norm() > 1e-9 * longest * longest + 1e-20 * size * size))
      fail_input(where, fmt::format("triangle {} at {} is flat", i, place((a + b + c) / 3)), kMend);
  }
}

// Where the open edges lie: connected ones are one hole, the longest rims first.
std::string holes(const Surface& surface, const std::vector<std::uint64_t>& open) {
  std::map<int, int> parent;
  const auto root = [&](int v) {
    if (parent.count(v) == 0) parent[v] = v;
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const std::uint64_t edge : open)
    parent[root(static_cast<int>(edge >> 32))] = root(static_cast<int>(edge & 0xffffffffu));
  struct Rim {
    std::size_t edges = 0;
    Vec3 sum = Vec3::Zero();
  };
  std::map<int, Rim> rims;
  for (const std::uint64_t edge : open) {
    Rim& rim = rims[root(static_cast<int>(edge >> 32))];
    ++rim.edges;
    rim.sum += surface.vertices[edge >> 32];
  }
  std::vector<Rim> sorted;
  for (const auto& [vertex, rim] : rims) sorted.push_back(rim);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Rim& a, const Rim& b) { return a.edges > b.edges; });
  constexpr std::size_t kNamed = 3;
  std::string text = fmt::format("{} hole{}", rims.size(), rims.size() > 1 ? "s" : "");
  for (std::size_t i = 0; i < std::min(kNamed, sorted.size()); ++i)
    text += fmt::format("{} of {} edges about {}", i == 0 ? ":" : ",", sorted[i].edges,
                        place(sorted[i].sum / static_cast<double>(sorted[i].edges)));
  return text + (sorted.size() > kNamed ? ", ..." : "");
}

// Directed edges sorted by their ends: each must be met by its opposite exactly once.
void check_closed(const Surface& surface, const std::string& where) {
  using Edge = std::pair<std::uint64_t, int>;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < surface.faces.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(surface.faces[i][k]);
      const auto b = static_cast<std::uint64_t>(surface.faces[i][(k + 1) % 3]);
      edges.emplace_back(a << 32 | b, static_cast<int>(i));
    }
  std::sort(edges.begin(), edges.end());
  const auto count = [&](std::uint64_t key) {
    const auto low = std::lower_bound(edges.begin(), edges.end(), Edge(key, -1));
    const auto high = std::lower_bound(edges.begin(), edges.end(), Edge(key + 1, -1));
    return high - low;
  };
  std::vector<std::uint64_t> open;
  for (const auto& [key, face] : edges) {
    const Vec3 middle = 0.5 * (surface.vertices[key >> 32] + surface.vertices[key & 0xffffffffu]);
    const auto opposite = count(key << 32 | key >> 32);
    if (count(key) > 1 || opposite > 1)
      fail_input(where,
                 fmt::format("the edge at {} of triangle {} has more than two triangles, or two of "
                             "opposite turn",
                             place(middle), face),
                 kMend);
    if (opposite == 0) open.push_back(key);
  }
  if (!open.empty())
    fail_input(where,
               fmt::format("the surface is open: {} edges have one triangle; {}", open.size(),
                           holes(surface, open)),
               kMend);
}

void check_parts(const Surface& surface, const std::string& where) {
  std::vector<int> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& f : surface.faces) {
    parent[root(f[1])] = root(f[0]);
    parent[root(f[2])] = root(f[0]);
  }
  const int first = root(surface.faces[0][0]);
  for (const Triangle& f : surface.faces)
    if (root(f[0]) != first)
      fail_input(
          where,
          fmt::format("the surface has several parts; one contains {}, another {}",
                      place(surface.vertices[surface.faces[0][0]]), place(surface.vertices[f[0]])),
          "keep the outer surface of one body: no cavities, no loose pieces");
}

}  // namespace

void check_surface(const Surface& surface, const std::string& where) {
  check_numbers(surface, where);
  const double size = diagonal(surface);
  if (!(size > 0)) fail_input(where, "all vertices are at one point", kMend);
  check_doubled(surface, 1e-9 * size, where);
  check_flat(surface, size, where);
  check_closed(surface, where);
  check_parts(surface, where);
  const double inside = signed_volume(surface);
  if (inside < -1e-9 * size * size * size)
    fail_input(where, "the surface is inside out: its triangles turn clockwise from outside",
               "reverse the order of each triangle's corners, or run hs-reconstruct");
  if (!(inside > 1e-9 * size * size * size))
    fail_input(where, "the surface encloses no volume: it is flat", kMend);
}

}  // namespace hapsim
