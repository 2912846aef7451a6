#include "geometry/crease.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "geometry/point_index.h"

namespace hapsim {
namespace {

const double kApart = std::cos(45 * M_PI / 180);   // between groups of normals
const double kWithin = std::cos(25 * M_PI / 180);  // from a group's mean
constexpr std::size_t kFewest = 3;                 // points in a group

struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
};

// The groups of normals about a place, as planes; fewer than two: no crease.
std::vector<Plane> planes_about(const PointCloud& cloud, const std::vector<Neighbour>& near,
                                double radius) {
  if (near.size() < 2 * kFewest) return {};
  const auto normal = [&](std::size_t i) -> const Vec3& { return cloud.normals[near[i].index]; };
  // Seeds: the normal farthest from the mean, then each the farthest from those before.
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < near.size(); ++i) mean += normal(i);
  std::size_t first = 0;
  for (std::size_t i = 1; i < near.size(); ++i) {
    if (normal(i).dot(mean) < normal(first).dot(mean)) first = i;
  }
  std::vector<Vec3> centre{normal(first)};
  while (centre.size() < 4) {
    double farthest = kApart;
    std::size_t best = near.size();
    for (std::size_t i = 0; i < near.size(); ++i) {
      double closest = -1;
      for (const Vec3& c : centre) closest = std::max(closest, c.dot(normal(i)));
      if (closest < farthest) {
        farthest = closest;
        best = i;
      }
    }
    if (best == near.size()) break;
    centre.push_back(normal(best));
  }
  if (centre.size() < 2) return {};
  std::vector<Plane> planes;
  for (int round = 0; round < 3; ++round) {
    std::vector<Plane> sum(centre.size());
    std::vector<std::size_t> count(centre.size(), 0);
    std::vector<double> weight(centre.size(), 0);
    for (std::size_t i = 0; i < near.size(); ++i) {
      for (std::size_t c = 0; c < centre.size(); ++c) {
        if (normal(i).dot(centre[c]) < kWithin) continue;
        const double away = 2 * near[i].distance / radius;
        const double w = std::exp(-away * away);
        sum[c].point += w * cloud.points[near[i].index];
        sum[c].normal += w * normal(i);
        weight[c] += w;
        ++count[c];
        break;
      }
    }
    // Largest first: a smaller group too near to a larger one is the blur between two.
    std::vector<std::size_t> order(sum.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return count[a] > count[b]; });
    planes.clear();
    centre.clear();
    for (const std::size_t c : order) {
      if (count[c] < kFewest) continue;
      const Vec3 n = sum[c].normal.normalized();
      if (std::any_of(centre.begin(), centre.end(),
                      [&](const Vec3& m) { return m.dot(n) > kApart; }))
        continue;
      planes.push_back({sum[c].point / weight[c], n});
      centre.push_back(n);
    }
  }
  return planes;
}

// Where the planes meet, nearest to v in the directions they leave free; of a rim vertex in its
// plane.
Vec3 meeting(const std::vector<Plane>& planes, const Vec3& v, bool rim) {
  Eigen::Matrix3d a = 1e-4 * Eigen::Matrix3d::Identity();
  Vec3 right = Vec3::Zero();
  for (const Plane& plane : planes) {
    a += plane.normal * plane.normal.transpose();
    right += plane.normal * plane.normal.dot(plane.point - v);
  }
  if (rim) a(2, 2) += 1e6;
  Vec3 x = v + Vec3(a.ldlt().solve(right));
  if (rim) x.z() = v.z();
  return x;
}

struct Candidate {
  int vertex;
  std::vector<Plane> planes;
  double distance;
  Vec3 target;
};

Vec3 normal_of(const Surface& surface, const Triangle& f) {
  const Vec3& a = surface.vertices[f[0]];
  return (surface.vertices[f[1]] - a).cross(surface.vertices[f[2]] - a);
}

double smallest_height(const Surface& surface, const Triangle& f) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, (surface.vertices[f[(k + 1) % 3]] - surface.vertices[f[k]]).norm());
  }
  return normal_of(surface, f).norm() / longest;
}

// Whether a face has a fair shape and looks the way of one of the planes, or of the bottom.
bool lies_well(const Surface& surface, const Triangle& f, const std::vector<Plane>& planes,
               const CreaseOptions& options) {
  if (smallest_height(surface, f) < 0.1 * options.edge) return false;
  const bool bottom = std::all_of(f.begin(), f.end(),
                                  [&](int v) { return surface.vertices[v].z() == options.base; });
  const Vec3 normal = normal_of(surface, f).normalized();
  if (bottom) return normal.z() < 0;
  return std::any_of(planes.begin(), planes.end(),
                     [&](const Plane& plane) { return plane.normal.dot(normal) > 0.6; });
}

// Flips edges between the sides of a crease onto it, once over the surface.
void flip_onto(Surface& surface, const std::vector<std::vector<Plane>>& planes_of,
               const CreaseOptions& options) {
  const auto moved = [&](int v) { return !planes_of[v].empty(); };
  std::map<std::pair<int, int>, int> face_of;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& t = surface.faces[f];
    for (int k = 0; k < 3; ++k) face_of[{t[k], t[(k + 1) % 3]}] = static_cast<int>(f);
  }
  std::vector<char> touched(surface.faces.size(), 0);
  std::set<std::pair<int, int>> made;
  for (const auto& [key, f] : face_of) {
    const auto [a, b] = key;
    if (a > b || (moved(a) && moved(b))) continue;
    const auto opposite = face_of.find({b, a});
    if (opposite == face_of.end()) continue;
    const int g = opposite->second;
    if (touched[f] || touched[g]) continue;
    const auto third = [&](int face) {
      const Triangle& t = surface.faces[face];
      return t[0] + t[1] + t[2] - a - b;
    };
    const int c = third(f), d = third(g);
    if (!moved(c) || !moved(d) || face_of.count({c, d}) > 0 || face_of.count({d, c}) > 0) continue;
    if (!made.emplace(std::min(c, d), std::max(c, d)).second) continue;
    // a, b, c turns as face f does; so do c, d, b and d, c, a.
    const Triangle one{c, d, b}, other{d, c, a};
    const bool sound = lies_well(surface, one, planes_of[c], options) &&
                       lies_well(surface, other, planes_of[c], options);
    const double before = normal_of(surface, surface.faces[f])
                              .normalized()
                              .dot(normal_of(surface, surface.faces[g]).normalized());
    const double after =
        normal_of(surface, one).normalized().dot(normal_of(surface, other).normalized());
    if (!sound || after > before) continue;  // the crease is the sharper of the two diagonals
    surface.faces[f] = one;
    surface.faces[g] = other;
    touched[f] = touched[g] = 1;
  }
}

}  // namespace

int snap_to_creases(Surface& surface, const PointCloud& cloud, const CreaseOptions& options) {
  const PointIndex index(cloud.points);
  // Wide, for a scan from above has few points on the walls; near ones weigh more.
  const double radius = std::max(4 * options.edge, 4 * options.spacing);

  std::vector<std::set<int>> ring(surface.vertices.size());
  std::vector<std::vector<int>> faces_of(surface.vertices.size());
  std::vector<char> side(surface.vertices.size(), 0);  // of a face that is not the bottom
  for (std::size_t n = 0; n < surface.faces.size(); ++n) {
    const Triangle& f = surface.faces[n];
    const bool bottom = std::all_of(f.begin(), f.end(),
                                    [&](int v) { return surface.vertices[v].z() == options.base; });
    for (int k = 0; k < 3; ++k) {
      faces_of[f[k]].push_back(static_cast<int>(n));
      ring[f[k]].insert(f[(k + 1) % 3]);
      if (!bottom) side[f[k]] = 1;
    }
  }
  std::vector<Candidate> candidates;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    if (!side[v]) continue;
    const Vec3& p = surface.vertices[v];
    const std::vector<Plane> planes = planes_about(cloud, index.within(p, radius), radius);
    if (planes.size() < 2) continue;
    const Vec3 target = meeting(planes, p, p.z() == options.base);
    const double distance = (target - p).norm();
    if (distance < 1.6 * options.edge) {
      candidates.push_back({static_cast<int>(v), planes, distance, target});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return std::pair(-static_cast<int>(a.planes.size()), a.distance) <
                            std::pair(-static_cast<int>(b.planes.size()), b.distance);
                   });
  std::vector<std::vector<Plane>> planes_of(surface.vertices.size());
  int count = 0;
  for (const Candidate& c : candidates) {
    const bool meets = std::any_of(ring[c.vertex].begin(), ring[c.vertex].end(), [&](int w) {
      return (surface.vertices[w] - c.target).norm() < 0.3 * options.edge;
    });
    if (meets) continue;
    const Vec3 old = surface.vertices[c.vertex];
    surface.vertices[c.vertex] = c.target;
    if (!std::all_of(faces_of[c.vertex].begin(), faces_of[c.vertex].end(), [&](int f) {
          return lies_well(surface, surface.faces[f], c.planes, options);
        })) {
      surface.vertices[c.vertex] = old;
      continue;
    }
    planes_of[c.vertex] = c.planes;
    ++count;
  }
  for (int pass = 0; pass < 2; ++pass) flip_onto(surface, planes_of, options);
  return count;
}

}  // namespace hapsim
