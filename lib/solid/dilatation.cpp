#include "solid/dilatation.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace hapsim {
namespace {

// Neighbours of each tetrahedron over its faces, in order.
std::vector<std::vector<int>> face_neighbours(const TetMesh& mesh) {
  struct Entry {
    std::array<int, 3> corners;
    int tet;
    bool operator<(const Entry& other) const {
      return corners != other.corners ? corners < other.corners : tet < other.tet;
    }
  };
  std::vector<Entry> faces;
  faces.reserve(4 * mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int left_out = 0; left_out < 4; ++left_out) {
      Entry e{{}, static_cast<int>(t)};
      for (int c = 0, k = 0; c < 4; ++c)
        if (c != left_out) e.corners[static_cast<std::size_t>(k++)] = mesh.tets[t][c];
      std::sort(e.corners.begin(), e.corners.end());
      faces.push_back(e);
    }
  std::sort(faces.begin(), faces.end());
  std::vector<std::vector<int>> neighbours(mesh.tets.size());
  for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    if (faces[i].corners == faces[i + 1].corners) {
      neighbours[faces[i].tet].push_back(faces[i + 1].tet);
      neighbours[faces[i + 1].tet].push_back(faces[i].tet);
    }
  for (auto& n : neighbours) std::sort(n.begin(), n.end());
  return neighbours;
}

}  // namespace

std::vector<int> dilatation_patches(const TetMesh& mesh, const std::vector<int>& kind, int size) {
  const auto neighbours = face_neighbours(mesh);
  std::vector<int> patch(mesh.tets.size(), -1);
  std::vector<std::vector<int>> members;
  for (std::size_t seed = 0; seed < mesh.tets.size(); ++seed) {
    if (patch[seed] >= 0) continue;
    const int number = static_cast<int>(members.size());
    members.emplace_back();
    std::set<int> nodes;
    const auto take = [&](int t) {
      patch[t] = number;
      members.back().push_back(t);
      nodes.insert(mesh.tets[t].begin(), mesh.tets[t].begin() + 4);
    };
    take(static_cast<int>(seed));
    while (static_cast<int>(members.back().size()) < size) {
      // The neighbour that brings the fewest new nodes keeps the patch compact.
      int best = -1, best_new = 5;
      for (const int m : members.back())
        for (const int t : neighbours[m]) {
          if (patch[t] >= 0 || kind[t] != kind[seed]) continue;
          int fresh = 0;
          for (int c = 0; c < 4; ++c) fresh += nodes.count(mesh.tets[t][c]) == 0;
          if (fresh < best_new || (fresh == best_new && t < best)) best = t, best_new = fresh;
        }
      if (best < 0) break;
      take(best);
    }
  }
  // Remnants join the smallest patch beside them.
  for (std::size_t p = 0; p < members.size(); ++p) {
    if (static_cast<int>(members[p].size()) >= (size + 1) / 2) continue;
    int best = -1;
    for (const int m : members[p])
      for (const int t : neighbours[m]) {
        const int other = patch[t];
        if (other == static_cast<int>(p) || kind[t] != kind[m]) continue;
        if (best < 0 || members[other].size() < members[best].size()) best = other;
      }
    if (best < 0) continue;
    for (const int m : members[p]) patch[m] = best;
    members[best].insert(members[best].end(), members[p].begin(), members[p].end());
    members[p].clear();
  }
  std::map<int, int> compact;
  for (int& p : patch) p = compact.try_emplace(p, static_cast<int>(compact.size())).first->second;
  return patch;
}

}  // namespace hapsim
