#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/median.h"
#include "mesh/point_index.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/plan_window.h"
#include "reconstruct/reconstruct_parts.h"

namespace hapsim {
namespace {

// How far points are apart at the sparse places, in plan view: a disc of this radius does not fall
// between them.
double plan_reach(const std::vector<Vec3>& points) {
  std::vector<Vec3> flat = points;
  for (Vec3& p : flat) p.z() = 0;
  const PointIndex index(flat);
  std::vector<double> sixth;
  for (const Vec3& p : flat) sixth.push_back(index.nearest(p, 7).back().distance);
  const double usual = quantile(sixth, 0.5);
  return std::max(1.6 * usual, std::min(1.2 * quantile(sixth, 0.97), 4 * usual));
}

constexpr double kSlopesEnd = 0.2;  // of the points' height, above and below them

}  // namespace

std::vector<Vec3> outline_of(const PointCloud& cloud, const BodyFrame& frame) {
  std::vector<Vec3> line;
  for (const Vec2& p : plan_outline(cloud.points, plan_reach(cloud.points), frame.edge))
    line.emplace_back(p.x(), p.y(), frame.base);
  return line;
}

Surface reconstruct_height(const PointCloud& cloud, const BodyFrame& frame) {
  const std::vector<Vec2> outline =
      outline_beyond(cloud.points, plan_reach(cloud.points), frame.edge, frame.beyond);
  int rim = 0;
  const Surface plan = plan_mesh(outline, frame.edge, rim);
  const std::vector<double> height = fit_heights(plan, cloud.points);

  const int n = static_cast<int>(plan.vertices.size());
  Surface body = plan;
  double rim_height = 0;
  // What goes on beyond the points stays between them, more or less: slopes end somewhere.
  double low = -std::numeric_limits<double>::infinity(), high = -low;
  if (frame.beyond > 0) {
    const auto [least, most] =
        std::minmax_element(cloud.points.begin(), cloud.points.end(),
                            [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    const double more = kSlopesEnd * (most->z() - least->z());
    low = least->z() - more;
    high = most->z() + more;
  }
  for (int v = 0; v < n; ++v) {
    // A body of no thickness cannot be meshed.
    body.vertices[v].z() = std::max(std::clamp(height[v], low, high), frame.base + frame.edge / 4);
    if (v < rim) rim_height += (body.vertices[v].z() - frame.base) / rim;
  }
  for (const Vec3& p : plan.vertices) body.vertices.emplace_back(p.x(), p.y(), frame.base);
  for (const Triangle& f : plan.faces) body.faces.push_back({f[0] + n, f[2] + n, f[1] + n});

  // Upright walls: columns under the rim, in as many steps as make their triangles even.
  const int steps = std::max(1, static_cast<int>(std::lround(rim_height / frame.edge)));
  const int first = static_cast<int>(body.vertices.size());
  for (int s = 1; s < steps; ++s) {
    for (int v = 0; v < rim; ++v) {
      const Vec3& top = body.vertices[v];
      const double share = static_cast<double>(s) / steps;
      body.vertices.emplace_back(top.x(), top.y(), top.z() + share * (frame.base - top.z()));
    }
  }
  const auto node = [&](int step, int v) {
    const int at = v % rim;
    return step == 0 ? at : step == steps ? at + n : first + (step - 1) * rim + at;
  };
  for (int s = 0; s < steps; ++s) {
    for (int v = 0; v < rim; ++v) {
      // Seen from outside the rim runs to the right, v to v + 1.
      const int a = node(s, v), b = node(s, v + 1), c = node(s + 1, v), d = node(s + 1, v + 1);
      if ((s + v) % 2 == 0) {
        body.faces.push_back({a, c, d});
        body.faces.push_back({a, d, b});
      } else {
        body.faces.push_back({a, c, b});
        body.faces.push_back({b, c, d});
      }
    }
  }
  return body;
}

}  // namespace hapsim
