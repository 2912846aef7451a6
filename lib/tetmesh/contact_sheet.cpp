// A body's surface about a contact, laid out flat.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tetmesh/contact_patch.h"

namespace hapsim {
namespace {

constexpr double kOn = 1e-9;  // relative: points on a common edge belong to both

double cross_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

std::vector<SheetPlan::Start> SheetPlan::crossings(const Eigen::Vector2d& direction) const {
  std::vector<Start> found;
  for (const auto& [a, b] : creases_) {
    const double from = cross_of(direction, a.head<2>()), to = cross_of(direction, b.head<2>());
    if ((from > 0) == (to > 0)) continue;
    const Vec3 p = a + from / (from - to) * (b - a);
    if (direction.dot(p.head<2>()) > 0) found.push_back({p, p.norm()});
  }
  std::sort(found.begin(), found.end(),
            [](const Start& x, const Start& y) { return x.way < y.way; });
  for (std::size_t k = 1; k < found.size(); ++k)
    found[k].way = found[k - 1].way + (found[k].point - found[k - 1].point).norm();
  return found;
}

Eigen::Vector2d SheetPlan::of(const Vec3& local) const {
  const double across = local.head<2>().norm(), distance = local.norm();
  if (!(across > 0)) return Eigen::Vector2d(distance, 0);
  const Eigen::Vector2d direction = local.head<2>() / across;
  Start last;
  if (has_creases())
    for (const Start& s : crossings(direction))
      if (s.point.norm() <= distance * (1 + kOn)) last = s;
  return (last.way + (local - last.point).norm()) * direction;
}

SheetPlan::Start SheetPlan::start(const Eigen::Vector2d& direction, double distance) const {
  Start last;
  if (has_creases())
    for (const Start& s : crossings(direction))
      if (s.way < distance) last = s;
  return last;
}

SheetMap::Facet SheetMap::facet(const Surface& surface, std::size_t f, const ContactFrame& frame) {
  const Triangle& t = surface.faces[f];
  Facet facet{frame.to_local(surface.vertices[t[0]]), frame.to_local(surface.vertices[t[1]]),
              frame.to_local(surface.vertices[t[2]]), Vec3::Zero()};
  facet.normal = (facet.b - facet.a).cross(facet.c - facet.a).normalized();
  return facet;
}

SheetMap::SheetMap(const Surface& fine, const Surface& coarse, const ContactFrame& frame,
                   const ContactRegion& region)
    : plan_(region.plan) {
  double farthest = 0;
  for (const int v : region.loop)
    farthest = std::max(farthest, (coarse.vertices[v] - frame.origin).norm());
  for (std::size_t f = 0; f < coarse.faces.size(); ++f)
    if (region.inside[f]) coarse_.push_back(facet(coarse, f, frame));
  for (std::size_t f = 0; f < fine.faces.size(); ++f) {
    const Facet t = facet(fine, f, frame);
    const Vec3 low = t.a.cwiseMin(t.b).cwiseMin(t.c), high = t.a.cwiseMax(t.b).cwiseMax(t.c);
    if ((low.array() > farthest).any() || (high.array() < -farthest).any()) continue;
    fine_.push_back(t);
  }
}

// On the half-plane through the normal in direction (u, v): p = s + l (cos x e + sin x z), s the
// last crease before, l the rest of the way, meets a facet's plane where n . p = n . a.
SheetMap::Spot SheetMap::at(double u, double v) const {
  const Eigen::Vector2d plan(u, v);
  const double distance = plan.norm();
  const Eigen::Vector2d way =
      distance > 0 ? Eigen::Vector2d(plan / distance) : Eigen::Vector2d(1, 0);
  const SheetPlan::Start start = plan_.start(way, distance);
  const double rest = distance - start.way, before = start.point.norm() * (1 - kOn);
  const Vec3 e(way.x(), way.y(), 0);
  // The facet's point of angle x nearest to `near`, if it has any.
  const auto meet = [&](const Facet& t, double near, double& x, Vec3& p) {
    const double A = t.normal.dot(e), B = t.normal.z(), scale = std::hypot(A, B);
    const double c = t.normal.dot(t.a - start.point) / std::max(rest, 1e-300);
    if (std::abs(c) > scale * (1 + kOn) || scale == 0) return false;
    const double middle = std::atan2(B, A), half = std::acos(std::clamp(c / scale, -1.0, 1.0));
    bool found = false;
    for (const double angle : {middle - half, middle + half}) {
      const Vec3 q = start.point + rest * (std::cos(angle) * e + std::sin(angle) * Vec3::UnitZ());
      if (q.dot(e) < -kOn * distance || q.norm() < before) continue;
      // In the triangle?
      const Vec3 n = (t.b - t.a).cross(t.c - t.a);
      const double whole = n.squaredNorm();
      const double wb = (q - t.a).cross(t.c - t.a).dot(n) / whole,
                   wc = (t.b - t.a).cross(q - t.a).dot(n) / whole;
      if (!(wb >= -kOn && wc >= -kOn && wb + wc <= 1 + kOn)) continue;
      const double turned = std::remainder(angle - near, 2 * M_PI);
      if (found && std::abs(turned) >= std::abs(std::remainder(x - near, 2 * M_PI))) continue;
      found = true, x = angle, p = q;
    }
    return found;
  };
  Spot spot{start.point + rest * e, Vec3::UnitZ()};
  double coarse = 0, gap = std::numeric_limits<double>::infinity(), x = 0;
  Vec3 p;
  for (const Facet& t : coarse_)
    if (meet(t, 0, x, p) && std::abs(std::remainder(x, 2 * M_PI)) < gap) {
      gap = std::abs(std::remainder(x, 2 * M_PI));
      coarse = x, spot = {p, t.normal};
    }
  gap = std::numeric_limits<double>::infinity();
  for (const Facet& t : fine_)
    if (meet(t, coarse, x, p) && std::abs(std::remainder(x - coarse, 2 * M_PI)) < gap) {
      gap = std::abs(std::remainder(x - coarse, 2 * M_PI));
      spot.point = p;
    }
  return spot;
}

}  // namespace hapsim
