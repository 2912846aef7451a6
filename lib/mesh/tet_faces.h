// The faces of tetrahedra brought together: private to lib/formats, lib/mesh and lib/tetmesh.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Corners of a tetrahedron's faces, counter-clockwise from outside when its volume is positive.
inline constexpr int kFaceCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// Calls visit(tet, face number 0-3, how many tetrahedra have it) for every different face, ordered
// by its sorted corners. Faces are put in buckets by their lowest corner: linear in their number.
template <class Visit>
void visit_faces(const TetMesh& mesh, Visit visit) {
  struct Entry {
    int middle, high;
    std::uint32_t tet;
    std::uint8_t face;
    bool operator<(const Entry& other) const {
      return middle != other.middle ? middle < other.middle : high < other.high;
    }
  };
  const auto low_corner = [&](const std::array<int, 10>& t, int f) {
    return std::min({t[kFaceCorners[f][0]], t[kFaceCorners[f][1]], t[kFaceCorners[f][2]]});
  };
  std::vector<std::uint32_t> first(mesh.nodes.size() + 2, 0);
  for (const auto& t : mesh.tets)
    for (int f = 0; f < 4; ++f) ++first[low_corner(t, f) + 2];
  for (std::size_t n = 2; n < first.size(); ++n) first[n] += first[n - 1];
  std::vector<Entry> entries(4 * mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i)
    for (int f = 0; f < 4; ++f) {
      const auto& t = mesh.tets[i];
      Triangle c{t[kFaceCorners[f][0]], t[kFaceCorners[f][1]], t[kFaceCorners[f][2]]};
      std::sort(c.begin(), c.end());
      entries[first[c[0] + 1]++] = {c[1], c[2], static_cast<std::uint32_t>(i),
                                    static_cast<std::uint8_t>(f)};
    }
  // first[n] is now where the bucket of n begins.
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const auto begin = entries.begin() + first[n], end = entries.begin() + first[n + 1];
    std::sort(begin, end);
    for (auto at = begin; at != end;) {
      auto next = at + 1;
      while (next != end && !(*at < *next)) ++next;
      visit(at->tet, static_cast<int>(at->face), static_cast<int>(next - at));
      at = next;
    }
  }
}

inline Triangle face_of(const TetMesh& mesh, std::size_t tet, int face) {
  const auto& t = mesh.tets[tet];
  return {t[kFaceCorners[face][0]], t[kFaceCorners[face][1]], t[kFaceCorners[face][2]]};
}

}  // namespace hapsim
