#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/union_find.h"
#include "mesh/surface_tree.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/crease.h"
#include "reconstruct/normals.h"
#include "reconstruct/poisson.h"
#include "reconstruct/raw_surface.h"
#include "reconstruct/reconstruct_parts.h"
#include "reconstruct/surface_fit.h"
#include "repair/remesh.h"
#include "repair/repair.h"
#include "repair/self_intersection.h"
#include "repair/wrap.h"

namespace hapsim {
namespace {

// The part that holds the largest volume, with compact vertices.
Surface largest_part(const Surface& surface) {
  std::vector<int> parent(surface.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Triangle& f : surface.faces) {
    parent[root(parent, f[1])] = root(parent, f[0]);
    parent[root(parent, f[2])] = root(parent, f[0]);
  }
  std::vector<double> volume(surface.vertices.size(), 0);
  for (const Triangle& f : surface.faces) {
    Surface one{{surface.vertices[f[0]], surface.vertices[f[1]], surface.vertices[f[2]]}, {}};
    const Vec3 o = surface.vertices.front();
    volume[root(parent, f[0])] +=
        (one.vertices[0] - o).dot((one.vertices[1] - o).cross(one.vertices[2] - o));
  }
  const int best =
      static_cast<int>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  Surface part;
  std::vector<int> number(surface.vertices.size(), -1);
  for (const Triangle& f : surface.faces) {
    if (root(parent, f[0]) != best) continue;
    Triangle g;
    for (int k = 0; k < 3; ++k) {
      if (number[f[k]] < 0) {
        number[f[k]] = static_cast<int>(part.vertices.size());
        part.vertices.push_back(surface.vertices[f[k]]);
      }
      g[k] = number[f[k]];
    }
    part.faces.push_back(g);
  }
  return part;
}

// The points above the base, wall points from the lowest ones down to it where there is a gap, and
// all of that again below it: the closed surface then crosses the base upright.
PointCloud mirrored(const PointCloud& cloud, const BodyFrame& frame) {
  PointCloud both;
  const auto add = [&](const Vec3& p, const Vec3& n) {
    both.points.push_back(p);
    both.normals.push_back(n);
    both.points.emplace_back(p.x(), p.y(), 2 * frame.base - p.z());
    both.normals.emplace_back(n.x(), n.y(), -n.z());
  };
  double low = 1e300;
  for (const Vec3& p : cloud.points) low = std::min(low, std::max(p.z(), frame.base));
  const bool gap = low - frame.base > 3 * frame.spacing;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3& p = cloud.points[i];
    const Vec3& n = cloud.normals[i];
    if (p.z() <= frame.base) continue;
    add(p, n);
    const double side = std::hypot(n.x(), n.y());
    if (!gap || side < 0.5 || p.z() > low + 2 * frame.spacing) continue;
    for (double z = low - frame.spacing; z > frame.base; z -= frame.spacing) {
      add({p.x(), p.y(), z}, Vec3(n.x(), n.y(), 0) / side);
    }
  }
  return both;
}

// Of the points' spacing: noise makes smaller balls; gaps up to which a wrap bridges; how far
// outside the points it lies before it is fitted.
constexpr double kLeastBall = 1.0;
constexpr double kWrapGap = 3.0;
constexpr double kWrapOffset = 0.3;
// Of the edge: how large the triangles of the Poisson surface are, and how far off it; they are
// made even and fitted to the points afterwards. The same roughly, and the points' spacing then.
constexpr double kPoissonCell = 0.7, kPoissonOff = 0.05;
constexpr double kRoughCell = 1.0, kRoughOff = 0.1, kRoughSpacing = 0.5;
constexpr double kTight = 0.1;  // of the edge: a wrap about triangles
constexpr int kWrapAttempts = 6;
constexpr double kDoubleSkin = 3;  // volume over offset and area: a double skin has about 1
constexpr double kCreaseDeg = 40;
// Each pass brings more of the rounded edge within reach.
constexpr int kCreasePasses = 4;
constexpr double kThinAngle = 3;  // [deg]

double smallest_angle_deg(const Surface& surface) {
  double largest = -1;
  for (const Triangle& f : surface.faces) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 u = surface.vertices[f[(k + 1) % 3]] - surface.vertices[f[k]];
      const Vec3 v = surface.vertices[f[(k + 2) % 3]] - surface.vertices[f[k]];
      largest = std::max(largest, u.dot(v) / (u.norm() * v.norm()));
    }
  }
  return std::acos(std::min(1.0, largest)) * 180 / M_PI;
}

double trimmed_rms(const Surface& surface, const std::vector<Vec3>& points) {
  const SurfaceTree tree(surface);
  std::vector<double> square;
  for (const Vec3& p : points) square.push_back(std::pow(tree.nearest(p).distance, 2));
  std::sort(square.begin(), square.end());
  // Gross outliers that cleaning left must not decide.
  const auto kept = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(square.size()));
  return std::sqrt(std::accumulate(square.begin(), square.begin() + kept, 0.0) /
                   static_cast<double>(std::max<std::ptrdiff_t>(kept, 1)));
}

// Sharp edges where the points have them: taken when the points then lie clearly nearer to the
// surface and it is still sound; else it stays as it was, and false.
bool sharpen(Surface& smooth, const PointCloud& cloud, const BodyFrame& frame,
             const RemeshOptions& even) {
  const Segmentation segmentation = find_patches(cloud, frame.spacing, kCreaseDeg);
  if (segmentation.patches.size() < 2) return false;
  CreaseOptions crease;
  crease.edge = frame.edge;
  crease.spacing = frame.spacing;
  crease.base = even.base;
  try {
    LabelledSurface sharp = cut_along_patches(smooth, segmentation, crease);
    RemeshOptions passing = even;
    passing.rounds = 2;
    for (int pass = 0; pass < kCreasePasses; ++pass) {
      project_to_patches(sharp, segmentation, crease);
      sharp.surface = remesh(sharp.surface, pass + 1 < kCreasePasses ? passing : even, sharp.label);
    }
    const int bad = project_to_patches(sharp, segmentation, crease);
    if (bad > 0 || smallest_angle_deg(sharp.surface) < kThinAngle) return false;
    check_self_intersection(sharp.surface, "");
    const double now = trimmed_rms(sharp.surface, cloud.points);
    if (now > 0.9 * trimmed_rms(smooth, cloud.points)) return false;
    smooth = std::move(sharp.surface);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// Bridges ever wider gaps until there is an inside: through a gap too wide the wrap creeps in and
// becomes a double skin.
template <class Wrap>
Surface wrapped(double gap, double offset, const Wrap& wrap) {
  Surface surface;
  for (int attempt = 0; attempt < kWrapAttempts; ++attempt, gap *= 1.5) {
    surface = largest_part(wrap(gap, offset));
    if (signed_volume(surface) > kDoubleSkin * offset * surface_area(surface)) break;
  }
  return surface;
}

// Triangles that a method left open or crossing: repaired or, where that cannot be, wrapped
// tightly.
Surface closed(const Surface& raw, const BodyFrame& frame, bool repair) {
  if (repair) {
    try {
      RepairReport mended;
      return repair_surface(raw, "the triangles between the points", mended);
    } catch (const Error&) {
    }
  }
  return wrapped(frame.edge, kTight * frame.edge,
                 [&](double gap, double offset) { return wrap_triangles(raw, gap, offset); });
}

// By the method, one closed manifold part.
Surface raw_surface(const PointCloud& cloud, const BodyFrame& frame, ReconstructMethod method) {
  switch (method) {
    case ReconstructMethod::kPowerCrust:
      // Its many slivers cross by rounding.
      return closed(power_crust(cloud, kLeastBall * frame.spacing), frame, false);
    case ReconstructMethod::kDelaunay:
      return closed(restricted_delaunay(cloud), frame, true);
    case ReconstructMethod::kAdvancingFront:
      return closed(advancing_front(cloud.points), frame, true);
    case ReconstructMethod::kWrap:
      return wrapped(
          kWrapGap * frame.spacing, kWrapOffset * frame.spacing,
          [&](double gap, double offset) { return wrap_points(cloud.points, gap, offset); });
    default:
      return largest_part(
          poisson_surface(cloud, (frame.roughly ? kRoughCell : kPoissonCell) * frame.edge,
                          (frame.roughly ? kRoughOff : kPoissonOff) * frame.edge, frame.seed));
  }
}

}  // namespace

Surface reconstruct_closed(const PointCloud& scan, const BodyFrame& frame, ReconstructMethod method,
                           bool& sharp) {
  const auto step = [&] {
    if (frame.step) frame.step();
  };
  // Planes through neighbours round the normals off at sharp edges, and with them the surface.
  PointCloud cloud = scan;
  sharpen_normals(cloud, 2.5 * frame.spacing, 30, 5);
  RemeshOptions even;
  even.edge = frame.edge;
  SurfaceFitOptions fit;
  const bool mirror = frame.has_base && !frame.all_round;
  const PointCloud raw = frame.roughly ? thin_points(cloud, kRoughSpacing * frame.edge) : cloud;
  Surface surface = raw_surface(mirror ? mirrored(raw, frame) : raw, frame, method);
  step();
  if (frame.has_base) {
    surface = largest_part(cut_flat(surface, frame.base));
    even.base = frame.base;
    fit.base = frame.base;
  }
  surface = remesh(surface, even);
  step();
  fit_surface(surface, cloud.points, fit);
  step();
  sharp = sharpen(surface, cloud, frame, even);
  step();
  return surface;
}

}  // namespace hapsim
