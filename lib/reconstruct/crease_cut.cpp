#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "reconstruct/crease.h"

namespace hapsim {
namespace {

constexpr int kNone = LabelledSurface::kFree;  // also of a vertex inside the bottom
constexpr int kAbout = 24;                     // points that say which patches are nearby

bool in_bottom(const Surface& surface, const Triangle& f, double base) {
  return std::all_of(f.begin(), f.end(), [&](int v) { return surface.vertices[v].z() == base; });
}

// The patch each vertex lies on.
std::vector<int> vertex_labels(const Surface& surface, const Segmentation& segmentation,
                               const std::vector<int>& patch_of, const PointIndex& index,
                               const CreaseOptions& options) {
  const std::size_t n = surface.vertices.size();
  std::vector<Vec3> normal(n, Vec3::Zero());
  std::vector<std::set<int>> ring(n);
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    if (in_bottom(surface, t, options.base)) continue;
    for (int k = 0; k < 3; ++k) {
      normal[t[k]] += face_normal(surface, static_cast<int>(f));
      ring[t[k]].insert(t[(k + 1) % 3]);
      ring[t[(k + 1) % 3]].insert(t[k]);
    }
  }
  std::vector<int> label(n, kNone);
  for (std::size_t v = 0; v < n; ++v) {
    if (ring[v].empty()) continue;
    const Vec3& p = surface.vertices[v];
    const Vec3 outward = normal[v].normalized();
    std::set<int> nearby;
    for (const Neighbour& m : index.nearest(p, kAbout)) nearby.insert(patch_of[m.index]);
    double least = 1e300;
    for (const int k : nearby) {
      const Patch& patch = segmentation.patches[k];
      const Patch::Height height = patch.height(p);
      if (height.normal.dot(outward) < -0.2) continue;
      // A patch ends about where its points do.
      const double beside = patch.distance_to_points(p) - std::abs(height.value);
      const double cost =
          std::abs(height.value) + 0.2 * std::max(0.0, beside - 1.5 * options.spacing);
      if (cost < least) {
        least = cost;
        label[v] = k;
      }
    }
  }
  // A vertex alone among others' is taken in; one without a patch nearby, too.
  for (int pass = 0; pass < 3; ++pass) {
    const std::vector<int> old = label;
    for (std::size_t v = 0; v < n; ++v) {
      std::map<int, int> votes;
      for (const int w : ring[v]) {
        if (old[w] != kNone) ++votes[old[w]];
      }
      if (votes.empty() || (old[v] != kNone && votes.count(old[v]) > 0)) continue;
      label[v] = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
                 })->first;
    }
  }
  return label;
}

}  // namespace

LabelledSurface cut_along_patches(const Surface& surface, const Segmentation& segmentation,
                                  const CreaseOptions& options) {
  // Only points that belong to a patch speak.
  std::vector<Vec3> points;
  std::vector<int> patch_of;
  for (const Patch& patch : segmentation.patches) {
    for (const Vec3& p : patch.points()) {
      points.push_back(p);
      patch_of.push_back(static_cast<int>(&patch - segmentation.patches.data()));
    }
  }
  const PointIndex index(points);
  const std::vector<int> label = vertex_labels(surface, segmentation, patch_of, index, options);

  LabelledSurface cut;
  cut.surface.vertices = surface.vertices;
  std::map<std::pair<int, int>, int> crossing;
  const auto add_vertex = [&](const Vec3& p) {
    cut.surface.vertices.push_back(p);
    return static_cast<int>(cut.surface.vertices.size()) - 1;
  };
  std::vector<Vec3>& at = cut.surface.vertices;
  for (const Triangle& f : surface.faces) {
    if (in_bottom(surface, f, options.base)) continue;
    for (int k = 0; k < 3; ++k) {
      const std::pair<int, int> key = std::minmax(f[k], f[(k + 1) % 3]);
      if (label[key.first] == label[key.second] || crossing.count(key) > 0) continue;
      crossing.emplace(key, add_vertex((at[key.first] + at[key.second]) / 2));
    }
  }
  const auto add_face = [&](int a, int b, int c, int l) {
    cut.surface.faces.push_back({a, b, c});
    cut.label.push_back(l);
  };
  for (const Triangle& f : surface.faces) {
    const bool bottom = in_bottom(surface, f, options.base);
    std::array<int, 3> mid;  // on the side from corner k to the next; -1: not cut
    int cuts = 0;
    for (int k = 0; k < 3; ++k) {
      const auto found = crossing.find(std::minmax(f[k], f[(k + 1) % 3]));
      mid[k] = found == crossing.end() ? -1 : found->second;
      cuts += mid[k] >= 0 ? 1 : 0;
    }
    const auto of = [&](int corner) {
      return bottom ? LabelledSurface::kBottom : label[f[corner]];
    };
    if (cuts == 0) {
      add_face(f[0], f[1], f[2], of(0));
    } else if (cuts == 1) {  // a side of the bottom
      const int k = static_cast<int>(
          std::find_if(mid.begin(), mid.end(), [](int m) { return m >= 0; }) - mid.begin());
      add_face(f[k], mid[k], f[(k + 2) % 3], of(k));
      add_face(mid[k], f[(k + 1) % 3], f[(k + 2) % 3], of((k + 1) % 3));
    } else if (cuts == 2) {
      // Corner a between the two cut sides stands alone.
      const int whole = static_cast<int>(std::find(mid.begin(), mid.end(), -1) - mid.begin());
      const int b = whole, c = (whole + 1) % 3, a = (whole + 2) % 3;
      const int ab = mid[a], ca = mid[c];
      add_face(f[a], ab, ca, of(a));
      add_face(ab, f[b], f[c], of(b));
      add_face(ab, f[c], ca, of(b));
    } else if (bottom) {
      for (int k = 0; k < 3; ++k) add_face(f[k], mid[k], mid[(k + 2) % 3], of(k));
      add_face(mid[0], mid[1], mid[2], of(0));
    } else {
      const int centre = add_vertex(
          (surface.vertices[f[0]] + surface.vertices[f[1]] + surface.vertices[f[2]]) / 3);
      for (int k = 0; k < 3; ++k) {
        add_face(f[k], mid[k], centre, of(k));
        add_face(f[k], centre, mid[(k + 2) % 3], of(k));
      }
    }
  }
  return cut;
}

}  // namespace hapsim
