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

bool inside_polygon(const std::vector<Vec3>& polygon, const Plane& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec3 &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

double distance_to_polygon(const std::vector<Vec3>& polygon, const Plane& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
    least = std::min(least, distance_to_segment(p, polygon[j].head<2>(), polygon[i].head<2>()));
  return least;
}

bool is_simple(const std::vector<Vec3>& polygon) {
  const std::size_t n = polygon.size();
  const auto side = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Plane a = polygon[i].head<2>(), b = polygon[j].head<2>(), c = polygon[k].head<2>();
    return cross2(b - a, c - a) > 0;
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

// Area of the part of a triangle within `radius` of the origin, by halving its longest edge.
double area_within(const Vec3& a, const Vec3& b, const Vec3& c, double radius, int depth) {
  const double longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
  const Vec3 centre = (a + b + c) / 3;
  if (centre.norm() > radius + longest) return 0;
  const double area = 0.5 * (b - a).cross(c - a).norm();
  if (std::max({a.norm(), b.norm(), c.norm()}) <= radius) return area;
  if (depth == 0 || longest < radius / 12) return centre.norm() <= radius ? area : 0;
  if ((a - b).norm() == longest)
    return area_within(a, (a + b) / 2, c, radius, depth - 1) +
           area_within((a + b) / 2, b, c, radius, depth - 1);
  return area_within(b, c, a, radius, depth);
}

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
    if (n.dot(own) > -0.2) sum += area_within(a, b, c, spread, 24) * n;
  }
  ContactFrame frame;
  frame.origin = nearest.point;
  frame.normal = sum.norm() > 0 ? Vec3(sum.normalized()) : own;
  int least = 0;
  frame.normal.cwiseAbs().minCoeff(&least);
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
  const auto distance = [&](int f, bool in_plan) {
    Vec3 a = local[surface.faces[f][0]], b = local[surface.faces[f][1]],
         c = local[surface.faces[f][2]];
    if (in_plan) a.z() = b.z() = c.z() = 0;
    return nearest_in_triangle(Vec3::Zero(), a, b, c).norm();
  };

  const int count = static_cast<int>(surface.faces.size());
  int start = -1;
  double nearest = std::numeric_limits<double>::infinity();
  for (int f = 0; f < count; ++f) {
    if (!looks_up(f)) continue;
    if (const double d = distance(f, false); d < nearest) {
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
      if (g >= 0 && !region.inside[g] && looks_up(g) && distance(g, true) < reach) {
        region.inside[g] = 1;
        stack.push_back(g);
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
    region.outline.emplace_back(local[v]);
    v = next[v];
  } while (v != first && region.loop.size() <= next.size());
  if (region.loop.size() != next.size()) return std::nullopt;  // has a hole
  if (!is_simple(region.outline) || !region.contains(0, 0, clear)) return std::nullopt;
  return region;
}

HeightMap::HeightMap(const Surface& fine, const Surface& coarse, const ContactFrame& frame,
                     const ContactRegion& region) {
  double low_u = 0, high_u = 0, low_v = 0, high_v = 0;
  for (const Vec3& p : region.outline) {
    low_u = std::min(low_u, p.x());
    high_u = std::max(high_u, p.x());
    low_v = std::min(low_v, p.y());
    high_v = std::max(high_v, p.y());
  }
  const auto facet = [&](const Surface& surface, std::size_t f) {
    const Triangle& t = surface.faces[f];
    return Facet{frame.to_local(surface.vertices[t[0]]), frame.to_local(surface.vertices[t[1]]),
                 frame.to_local(surface.vertices[t[2]])};
  };
  for (std::size_t f = 0; f < coarse.faces.size(); ++f)
    if (region.inside[f]) coarse_.push_back(facet(coarse, f));
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    const Facet t = facet(fine, f);
    if (std::max({t.a.x(), t.b.x(), t.c.x()}) < low_u ||
        std::min({t.a.x(), t.b.x(), t.c.x()}) > high_u ||
        std::max({t.a.y(), t.b.y(), t.c.y()}) < low_v ||
        std::min({t.a.y(), t.b.y(), t.c.y()}) > high_v)
      continue;
    const Vec3 n = (t.b - t.a).cross(t.c - t.a);
    if (n.z() > 0.1 * n.norm()) fine_.push_back(t);
  }
}

std::optional<double> HeightMap::height(const Facet& t, double u, double v) {
  const Plane p(u, v), a = t.a.head<2>(), b = t.b.head<2>(), c = t.c.head<2>();
  const double whole = cross2(b - a, c - a);
  const double wb = cross2(p - a, c - a) / whole, wc = cross2(b - a, p - a) / whole;
  constexpr double kSlack = 1e-9;  // points on a common edge belong to both
  if (!(wb >= -kSlack && wc >= -kSlack && wb + wc <= 1 + kSlack)) return std::nullopt;
  return t.a.z() + wb * (t.b.z() - t.a.z()) + wc * (t.c.z() - t.a.z());
}

double HeightMap::at(double u, double v) const {
  double coarse = 0;
  for (const Facet& facet : coarse_)
    if (const auto h = height(facet, u, v)) {
      coarse = *h;
      break;
    }
  double best = coarse, gap = std::numeric_limits<double>::infinity();
  for (const Facet& facet : fine_)
    if (const auto h = height(facet, u, v); h && std::abs(*h - coarse) < gap) {
      gap = std::abs(*h - coarse);
      best = *h;
    }
  return best;
}

}  // namespace hapsim
