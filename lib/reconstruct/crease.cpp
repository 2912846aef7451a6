#include "reconstruct/crease.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

namespace hapsim {
namespace {

constexpr int kSteps = 6;
constexpr double kFar = 2.0;  // edges a vertex may move at once

// Where the patches' heights vanish, nearest to p in the directions they leave free.
Vec3 meeting(const std::set<int>& labels, const Segmentation& segmentation, const Vec3& p,
             bool flat) {
  Vec3 x = p;
  for (int step = 0; step < kSteps; ++step) {
    // The trace of stiffness keeps nearly parallel patches from throwing the vertex far away.
    Eigen::Matrix3d a = 1e-3 * Eigen::Matrix3d::Identity();
    Vec3 right = Vec3::Zero();
    for (const int k : labels) {
      if (k < 0) continue;
      const Patch::Height h = segmentation.patches[k].height(x);
      a += h.normal * h.normal.transpose();
      right -= h.value * h.normal;
    }
    if (flat) a(2, 2) += 1e6;
    Vec3 d = a.ldlt().solve(right);
    if (flat) d.z() = 0;
    x += d;
  }
  return x;
}

// Height over longest side; negative when the face looks away
// from its patch.
double soundness(const LabelledSurface& labelled, std::size_t f, const Segmentation& segmentation) {
  const Triangle& t = labelled.surface.faces[f];
  const auto& at = labelled.surface.vertices;
  const Vec3 n = face_normal(labelled.surface, static_cast<int>(f));
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (at[t[k]] - at[t[(k + 1) % 3]]).norm());
  if (!(longest > 0)) return 0;
  const double shape = n.norm() / (longest * longest);
  const int label = labelled.label[f];
  if (label == LabelledSurface::kBottom) return n.z() < 0 ? shape : -shape;
  if (label == LabelledSurface::kFree) return shape;
  const Vec3 centre = (at[t[0]] + at[t[1]] + at[t[2]]) / 3;
  return segmentation.patches[label].height(centre).normal.dot(n) > 0.3 * n.norm() ? shape : -shape;
}

}  // namespace

int project_to_patches(LabelledSurface& labelled, const Segmentation& segmentation,
                       const CreaseOptions& options) {
  std::vector<Vec3>& at = labelled.surface.vertices;
  const std::vector<Triangle>& faces = labelled.surface.faces;
  std::vector<std::set<int>> labels(at.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const int v : faces[f]) labels[v].insert(labelled.label[f]);
  }
  const std::vector<Vec3> old = at;
  std::vector<Vec3> target = old;
  for (std::size_t v = 0; v < at.size(); ++v) {
    const bool flat = labels[v].count(LabelledSurface::kBottom) > 0;
    if (flat && labels[v].size() == 1) continue;
    const Vec3 x = meeting(labels[v], segmentation, old[v], flat);
    if ((x - old[v]).norm() < kFar * options.edge) target[v] = x;
  }
  std::vector<double> before(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) before[f] = soundness(labelled, f, segmentation);
  std::vector<double> share(at.size(), 1);
  int bad = 0;
  constexpr int kHalvings = 5;
  for (int attempt = 0; attempt <= kHalvings; ++attempt) {
    for (std::size_t v = 0; v < at.size(); ++v) {
      at[v] = share[v] == 1 ? target[v] : Vec3(old[v] + share[v] * (target[v] - old[v]));
    }
    bad = 0;
    std::vector<char> hold(at.size(), 0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const double now = soundness(labelled, f, segmentation);
      if (now > 0) continue;
      ++bad;
      // A face that was bad before is none the worse for moving.
      if (before[f] <= 0) continue;
      for (const int v : faces[f]) hold[v] = 1;
    }
    if (attempt == kHalvings) break;
    bool changed = false;
    for (std::size_t v = 0; v < at.size(); ++v) {
      if (!hold[v]) continue;
      share[v] = attempt + 2 == kHalvings ? 0 : share[v] / 2;
      changed = true;
    }
    if (!changed) break;
  }
  return bad;
}

}  // namespace hapsim
