// Frame of a contact and the hole that is cut for it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>

#include "mesh/surface_tree.h"
#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

using Plane = Eigen::Vector2d;

double cross2(const Plane& a, const Plane& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double distance_to_segment(const Plane& p, const Plane& a, const Plane& b) {
  const Plane d = b - a;
  const double t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-300), 0.0, 1.0);
  return (p - a - t * d).norm();
}

bool inside_polygon(const std::vector<Plane>& polygon, const Plane& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Plane &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

double distance_to_polygon(const std::vector<Plane>& polygon, const Plane& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    least = std::min(least, distance_to_segment(p, polygon[j], polygon[i]));
  return least;
}

bool is_simple(const std::vector<Plane>& polygon) {
  const std::size_t n = polygon.size();
  const auto side = [&](std::size_t i, std::size_t j, std::size_t k) {
    return cross2(polygon[j] - polygon[i], polygon[k] - polygon[i]) > 0;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      const std::size_t i1 = i + 1, j1 = (j + 1) % n;
      if (j1 == i) continue;
      if (side(i, i1, j) != side(i, i1, j1) && side(j, j1, i) != side(j, j1, i1)) return false;
    }
  return true;
}

// faces[f] has its edge k against face result[f][k], -1 for none.
std::vector<std::array<int, 3>> neighbours(const Surface& surface) {
  struct Side {
    std::uint64_t key;
    int face, edge;
    bool operator<(const Side& other) const { return key < other.key; }
  };
  std::vector<Side> sides;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(surface.faces[f][k], surface.faces[f][(k + 1) % 3]);
      sides.push_back({static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high),
                       static_cast<int>(f), k});
    }
  std::stable_sort(sides.begin(), sides.end());
  std::vector<std::array<int, 3>> result(surface.faces.size(), {-1, -1, -1});
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].key == sides[i + 1].key) {
      result[sides[i].face][sides[i].edge] = sides[i + 1].face;
      result[sides[i + 1].face][sides[i + 1].edge] = sides[i].face;
    }
  return result;
}

// Area that the disc of `radius` about the origin has in common with the triangle of the origin, p
// and q, negative if that turns clockwise.
double area_seen(const Plane& p, const Plane& q, double radius) {
  const auto sector = [&](const Plane& a, const Plane& b) {
    return 0.5 * radius * radius * std::atan2(cross2(a, b), a.dot(b));
  };
  const Plane d = q - p;
  // |p + t d| = radius
  const double aa = d.squaredNorm(), ab = p.dot(d),
               root = ab * ab - aa * (p.squaredNorm() - radius * radius);
  if (aa == 0) return 0;
  if (root <= 0) return sector(p, q);
  const double in = (-ab - std::sqrt(root)) / aa, out = (-ab + std::sqrt(root)) / aa;
  if (in >= 1 || out <= 0) return sector(p, q);
  const Plane a = p + std::max(in, 0.0) * d, b = p + std::min(out, 1.0) * d;
  return (in > 0 ? sector(p, a) : 0) + 0.5 * cross2(a, b) + (out < 1 ? sector(b, q) : 0);
}

// Area of the part of a triangle within `radius` of the origin; n: its unit normal.
double area_within(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double radius) {
  const double height = n.dot(a), square = radius * radius - height * height;
  if (square <= 0) return 0;
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  const auto flat = [&](const Vec3& p) { return Plane(p.dot(u), p.dot(v)); };
  const double r = std::sqrt(square);
  return std::abs(area_seen(flat(a), flat(b), r) + area_seen(flat(b), flat(c), r) +
                  area_seen(flat(c), flat(a), r));
}

// Faces whose normals differ by more meet in a crease.
constexpr double kCrease = 0.766;  // cosine of 40 degrees

}  // namespace

Vec3 ContactFrame::to_local(const Vec3& p) const {
  const Vec3 d = p - origin;
  return {d.dot(axis_u), d.dot(axis_v), d.dot(normal)};
}

Vec3 ContactFrame::to_global(const Vec3& p) const {
  return origin + p.x() * axis_u + p.y() * axis_v + p.z() * normal;
}

ContactFrame contact_frame(const Surface& fine, const Vec3& contact, double spread) {
  const SurfacePoint nearest = nearest_point(fine, contact);
  const Vec3 own = face_normal(fine, nearest.face).normalized();
  Vec3 sum = Vec3::Zero();
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    const Vec3 a = fine.vertices[fine.faces[f][0]] - nearest.point,
               b = fine.vertices[fine.faces[f][1]] - nearest.point,
               c = fine.vertices[fine.faces[f][2]] - nearest.point;
    if ((a.array() > spread && b.array() > spread && c.array() > spread).any() ||
        (a.array() < -spread && b.array() < -spread && c.array() < -spread).any())
      continue;
    const Vec3 n = (b - a).cross(c - a).normalized();
    // An edge of a box may turn by a right angle; the far side of a thin body looks away.
    if (n.dot(own) > -0.2) sum += area_within(a, b, c, n, spread) * n;
  }
  ContactFrame frame;
  frame.origin = nearest.point;
  frame.normal = sum.norm() > 0 ? Vec3(sum.normalized()) : own;
  int least = 0;  // rounding must not turn the frame
  for (int k = 1; k < 3; ++k)
    if (std::abs(frame.normal[k]) < std::abs(frame.normal[least]) - 0.1) least = k;
  frame.axis_u = Vec3::Unit(least).cross(frame.normal).normalized();
  frame.axis_v = frame.normal.cross(frame.axis_u);
  return frame;
}

bool ContactRegion::contains(double u, double v, double clearance) const {
  return inside_polygon(outline, {u, v}) && distance_to_polygon(outline, {u, v}) >= clearance;
}

std::optional<ContactRegion> contact_region(const ClassedSurface& coarse, const ContactFrame& frame,
                                            double reach, double tilt_deg, double clear) {
  const Surface& surface = coarse.surface;
  std::vector<Vec3> local;
  for (const Vec3& p : surface.vertices) local.push_back(frame.to_local(p));
  const double least_cosine = std::cos(tilt_deg * std::numbers::pi / 180);
  const auto looks_up = [&](int f) {
    const Vec3 n = face_normal(surface, f);
    return !coarse.face_class[f] && n.dot(frame.normal) > least_cosine * n.norm();
  };
  const auto distance = [&](int f) {
    const Triangle& t = surface.faces[f];
    return nearest_in_triangle(Vec3::Zero(), local[t[0]], local[t[1]], local[t[2]]).norm();
  };

  const int count = static_cast<int>(surface.faces.size());
  int start = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (int f = 0; f < count; ++f) {
    if (!looks_up(f)) continue;
    if (const double d = distance(f); d < nearest) {
      nearest = d;
      start = f;
    }
  }
  if (start < 0) return std::nullopt;

  ContactRegion region;
  region.inside.assign(surface.faces.size(), 0);
  const auto across = neighbours(surface);
  std::vector<int> stack{start};
  region.inside[start] = 1;
  while (!stack.empty()) {
    const int f = stack.back();
    stack.pop_back();
    for (const int g : across[f])
      if (g >= 0 && !region.inside[g] && looks_up(g) && distance(g) < reach) {
        region.inside[g] = 1;
        stack.push_back(g);
      }
  }

  for (int f = 0; f < count; ++f) {
    if (!region.inside[f]) continue;
    for (int k = 0; k < 3; ++k) {
      const int g = across[f][k];
      if (g <= f || !region.inside[g]) continue;
      const Vec3 n = face_normal(surface, f), m = face_normal(surface, g);
      if (n.dot(m) < kCrease * n.norm() * m.norm())
        region.plan.add_crease(local[surface.faces[f][k]], local[surface.faces[f][(k + 1) % 3]]);
    }
  }

  std::map<int, int> next;  // along the boundary, the region to the left
  for (int f = 0; f < count; ++f) {
    if (!region.inside[f]) continue;
    for (int k = 0; k < 3; ++k) {
      if (across[f][k] >= 0 && region.inside[across[f][k]]) continue;
      if (!next.emplace(surface.faces[f][k], surface.faces[f][(k + 1) % 3]).second)
        return std::nullopt;  // touches itself in a vertex
    }
  }
  if (next.empty()) return std::nullopt;
  const int first = next.begin()->first;
  int v = first;
  do {
    region.loop.push_back(v);
    region.outline.push_back(region.plan.of(local[v]));
    v = next[v];
  } while (v != first && region.loop.size() <= next.size());
  if (region.loop.size() != next.size()) return std::nullopt;  // has a hole
  if (!is_simple(region.outline) || !region.contains(0, 0, clear)) return std::nullopt;
  return region;
}

}  // namespace hapsim
