#include "solid/level_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"

namespace hapsim {
namespace {

// Crossings of the ray p + t d, t > 0, with the surface; nothing when it comes close to an edge.
std::optional<int> crossings(const Surface& surface, const Vec3& p, const Vec3& d) {
  constexpr double kClose = 1e-9;
  int count = 0;
  for (const Triangle& f : surface.faces) {
    const Vec3 a = surface.vertices[f[0]] - p, b = surface.vertices[f[1]] - p,
               c = surface.vertices[f[2]] - p;
    // Signed volumes of the ray with the edges: all of one sign when it passes inside.
    const double u = d.dot(b.cross(c)), v = d.dot(c.cross(a)), w = d.dot(a.cross(b));
    const double least = std::min({u, v, w}), most = std::max({u, v, w});
    const double scale = kClose * std::max(std::abs(least), std::abs(most));
    if (least < -scale && most > scale) continue;
    const double sum = u + v + w;
    if (std::min({std::abs(u), std::abs(v), std::abs(w)}) <= scale) {
      if ((a + b + c).dot(d) < -3 * (b - a).norm() - 3 * (c - a).norm()) continue;  // behind
      return std::nullopt;
    }
    // Distance along the ray: a.(n)/d.(n), n = (b - a) x (c - a), with d.n = sum.
    count += a.dot((b - a).cross(c - a)) / sum > 0;
  }
  return count;
}

}  // namespace

bool inside_polygon(const std::vector<Vec3>& polygon, const Vec3& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec3 &a = polygon[i], &b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y()))
      inside = !inside;
  }
  return inside;
}

bool inside_polyhedron(const Surface& closed, const Vec3& p) {
  for (int turn = 0; turn < 16; ++turn) {
    // Directions spread by the golden angle: none along the axes, where meshes have their edges.
    const double z = -0.93 + 0.113 * turn, angle = 0.7 + 2.399963 * turn;
    const double r = std::sqrt(1 - z * z);
    const auto count = crossings(closed, p, {r * std::cos(angle), r * std::sin(angle), z});
    if (count) return *count % 2 == 1;
  }
  fail_input("", "no ray tells inside from outside of the surface",
             "check that the surface is closed and has an area");
}

LevelSet polygon_level(const std::vector<Vec3>& polygon) {
  if (polygon.size() < 3) fail_input("", "a polygon has fewer than three corners", "add corners");
  return [polygon](const Vec3& p) {
    const Eigen::Index corners = static_cast<Eigen::Index>(polygon.size());
    LevelValue result{0, Eigen::VectorXd::Zero(2 * corners)};
    double best = std::numeric_limits<double>::infinity(), best_share = 0;
    Eigen::Index edge = 0;
    for (Eigen::Index i = 0; i < corners; ++i) {
      const Eigen::Vector2d a = polygon[i].head<2>(), b = polygon[(i + 1) % corners].head<2>();
      const double share = std::clamp(
          (p.head<2>() - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-300), 0.0, 1.0);
      const double d = (p.head<2>() - a - share * (b - a)).norm();
      if (d < best) best = d, edge = i, best_share = share;
    }
    const Eigen::Index next = (edge + 1) % corners;
    const Eigen::Vector2d foot =
        (1 - best_share) * polygon[edge].head<2>() + best_share * polygon[next].head<2>();
    const double sign = inside_polygon(polygon, p) ? -1 : 1;
    result.value = sign * best;
    result.clear = best;
    if (best > 0) {
      const Eigen::Vector2d by_foot = -sign * (p.head<2>() - foot) / best;
      result.by_parameters.segment<2>(2 * edge) = (1 - best_share) * by_foot;
      result.by_parameters.segment<2>(2 * next) = best_share * by_foot;
    }
    return result;
  };
}

LevelSet polyhedron_level(const Surface& closed) {
  const auto tree = std::make_shared<const SurfaceTree>(closed);
  return [tree](const Vec3& p) {
    const double sign = inside_polyhedron(tree->surface(), p) ? -1 : 1;
    const double distance = tree->nearest(p).distance;
    return LevelValue{sign * distance, Eigen::VectorXd::Constant(1, -1.0), distance};
  };
}

LevelSet layer_level(const Surface& surface, double thickness) {
  return layer_level(std::make_shared<const SurfaceTree>(surface), thickness);
}

LevelSet layer_level(std::shared_ptr<const SurfaceTree> tree, double thickness) {
  return [tree = std::move(tree), thickness](const Vec3& p) {
    const double level = tree->nearest(p).distance - thickness;
    return LevelValue{level, Eigen::VectorXd::Constant(1, -1.0), std::abs(level)};
  };
}

LevelSet ellipsoid_level(const Vec3& centre, const Vec3& s) {
  if (!(s.minCoeff() > 0))
    fail_input("", "a semi-axis of an ellipsoid is not positive", "give three above 0");
  return [centre, s](const Vec3& p) {
    // q = |y|, y_k = (p - c)_k / s_k; g = |grad q| |y| = |z|, z_k = y_k / s_k;
    // level = (q - 1) q / g. At the centre the limit is minus the least semi-axis.
    const Vec3 y = (p - centre).cwiseQuotient(s), z = y.cwiseQuotient(s);
    const double q = y.norm(), g = z.norm();
    LevelValue result{-s.minCoeff(), Eigen::VectorXd::Zero(6), std::abs(q - 1) * s.minCoeff()};
    if (q < 1e-9) return result;
    result.value = (q - 1) * q / g;
    // By y_k (through q) and z_k (through g).
    const double by_q = (2 * q - 1) / g, by_g = -result.value / g;
    for (int k = 0; k < 3; ++k) {
      const double dq = y[k] / q, dg = z[k] / g;  // by y_k, by z_k
      result.by_parameters[k] = by_q * dq * (-1 / s[k]) + by_g * dg * (-1 / (s[k] * s[k]));
      result.by_parameters[3 + k] = by_q * dq * (-y[k] / s[k]) + by_g * dg * (-2 * z[k] / s[k]);
    }
    return result;
  };
}

}  // namespace hapsim
