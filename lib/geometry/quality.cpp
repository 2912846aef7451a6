#include "geometry/quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hapsim {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.front(), values[values.size() / 2], values.back()};
}

// Smallest and largest angle between two faces, in degrees.
std::pair<double, double> dihedrals(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> outward;  // of the face opposite each corner
  constexpr int kOpposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int f = 0; f < 4; ++f)
    outward[f] = (p[kOpposite[f][1]] - p[kOpposite[f][0]])
                     .cross(p[kOpposite[f][2]] - p[kOpposite[f][0]])
                     .normalized();
  double least = 180, most = 0;
  for (int f = 0; f < 4; ++f)
    for (int g = f + 1; g < 4; ++g) {
      const double angle = std::acos(std::clamp(-outward[f].dot(outward[g]), -1.0, 1.0)) / kDegree;
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  return {least, most};
}

}  // namespace

double radius_edge_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  // The circumcentre solves 2 (u, v, w) . x = (|u|^2, |v|^2, |w|^2).
  const Vec3 centre =
      (u.squaredNorm() * v.cross(w) + v.squaredNorm() * w.cross(u) + w.squaredNorm() * u.cross(v)) /
      (2 * u.dot(v.cross(w)));
  const double shortest =
      std::min({u.norm(), v.norm(), w.norm(), (b - c).norm(), (c - d).norm(), (d - b).norm()});
  return centre.norm() / shortest;
}

TetQuality tet_quality(const TetMesh& mesh) {
  TetQuality quality;
  std::vector<double> ratio, smallest;
  double worst = 1e300;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Vec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = mesh.nodes[mesh.tets[t][k]];
    const double v = tet_volume(mesh, t);
    quality.volume += v;
    double merit = -1;  // below any angle
    if (v > 0) {
      const auto [least, most] = dihedrals(p);
      ratio.push_back(radius_edge_ratio(p[0], p[1], p[2], p[3]));
      smallest.push_back(least);
      quality.largest_dihedral_deg = std::max(quality.largest_dihedral_deg, most);
      merit = least;
    } else {
      ++quality.inverted;
    }
    if (merit < worst) {
      worst = merit;
      quality.worst = t;
      quality.worst_place = (p[0] + p[1] + p[2] + p[3]) / 4;
    }
  }
  quality.radius_edge = spread(std::move(ratio));
  quality.smallest_dihedral_deg = spread(std::move(smallest));
  return quality;
}

}  // namespace hapsim
