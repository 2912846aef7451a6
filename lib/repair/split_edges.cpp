#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "repair/coarsen.h"

namespace hapsim {
namespace {

struct Side {
  double length;  // squared
  std::uint64_t key;
  int face, edge;
};

std::uint64_t key_of(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

Vec3 middle_of(const Surface& surface, std::uint64_t key) {
  return 0.5 * (surface.vertices[key >> 32] + surface.vertices[key & 0xffffffffu]);
}

// The longest edge of a face, ties to the larger key so that both its faces agree.
Side longest_side(const Surface& surface, int face) {
  const Triangle& f = surface.faces[face];
  Side best{-1, 0, face, 0};
  for (int k = 0; k < 3; ++k) {
    const int a = f[k], b = f[(k + 1) % 3];
    const double length = (surface.vertices[a] - surface.vertices[b]).squaredNorm();
    const std::uint64_t key = key_of(a, b);
    if (length > best.length || (length == best.length && key > best.key))
      best = {length, key, face, k};
  }
  return best;
}

// The edges to be split now: each the longest of both its faces, found by walking from each face
// whose longest edge is too long across that edge as long as the next face has a longer one.
std::vector<std::pair<Side, Side>> terminal_edges(const Surface& surface,
                                                  const std::function<double(const Vec3&)>& limit) {
  std::map<std::uint64_t, std::array<int, 2>> faces_of;
  std::vector<Side> longest;
  for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f) {
    longest.push_back(longest_side(surface, f));
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t key = key_of(surface.faces[f][k], surface.faces[f][(k + 1) % 3]);
      const auto [found, fresh] = faces_of.insert({key, {f, f}});
      if (!fresh) found->second[1] = f;
    }
  }
  std::map<std::uint64_t, std::pair<Side, Side>> found;  // by key: a fixed order
  for (const Side& start : longest) {
    if (std::sqrt(start.length) <= limit(middle_of(surface, start.key))) continue;
    Side side = start;
    while (true) {
      const auto& pair = faces_of[side.key];
      const Side& next = longest[pair[0] == side.face ? pair[1] : pair[0]];
      if (next.key == side.key) {
        if (side.face < next.face) found.insert({side.key, {side, next}});
        if (side.face > next.face) found.insert({side.key, {next, side}});
        break;
      }
      side = next;
    }
  }
  std::vector<std::pair<Side, Side>> result;
  for (const auto& [key, pair] : found) result.push_back(pair);
  return result;
}

}  // namespace

ClassedSurface split_long_edges(const ClassedSurface& surface,
                                const std::function<double(const Vec3&)>& limit) {
  ClassedSurface result = surface;
  Surface& s = result.surface;
  while (true) {
    const auto edges = terminal_edges(s, limit);
    if (edges.empty()) return result;
    for (const auto& [one, two] : edges) {
      const int middle = static_cast<int>(s.vertices.size());
      s.vertices.push_back(middle_of(s, one.key));
      for (const Side& side : {one, two}) {
        Triangle& f = s.faces[side.face];
        Triangle other = f;
        other[side.edge] = middle;
        f[(side.edge + 1) % 3] = middle;
        s.faces.push_back(other);
        result.face_class.push_back(result.face_class[side.face]);
      }
    }
  }
}

}  // namespace hapsim
