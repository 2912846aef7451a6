#include "mesh/quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/median.h"

namespace hapsim {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

constexpr std::size_t kWorst = 10;

Spread spread(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, upper_median(values), *most};
}

Histogram histogram(const std::vector<double>& values, std::vector<double> edges) {
  Histogram result{std::move(edges), {}};
  result.count.assign(result.edge.size(), 0);
  for (const double v : values) {
    const auto next = std::upper_bound(result.edge.begin(), result.edge.end(), v);
    ++result.count[static_cast<std::size_t>(
        std::max<std::ptrdiff_t>(next - result.edge.begin() - 1, 0))];
  }
  return result;
}

// Longest edge over inscribed radius, which is three times the volume over the faces' area.
double aspect_ratio(const std::array<Vec3, 4>& p, double volume, double longest) {
  double area = 0;
  for (int f = 0; f < 4; ++f)
    area += 0.5 * (p[(f + 1) % 4] - p[f]).cross(p[(f + 2) % 4] - p[f]).norm();
  return longest * area / (3 * volume) / (2 * std::sqrt(6.0));
}

// Smallest and largest angle between two faces, in degrees.
std::pair<double, double> dihedrals(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> outward;  // of the face opposite each corner
  constexpr int kOpposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int f = 0; f < 4; ++f)
    outward[f] = (p[kOpposite[f][1]] - p[kOpposite[f][0]])
                     .cross(p[kOpposite[f][2]] - p[kOpposite[f][0]])
                     .normalized();
  double least = -1, most = 1;  // cosines
  for (int f = 0; f < 4; ++f)
    for (int g = f + 1; g < 4; ++g) {
      const double cosine = std::clamp(-outward[f].dot(outward[g]), -1.0, 1.0);
      least = std::max(least, cosine);
      most = std::min(most, cosine);
    }
  return {std::acos(least) / kDegree, std::acos(most) / kDegree};
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
  std::vector<double> ratio, smallest, aspect, edges;
  for (auto* values : {&ratio, &smallest, &aspect}) values->reserve(mesh.tets.size());
  edges.reserve(6 * mesh.tets.size());
  // A heap of the worst, the best of them on top.
  const auto better = [](const BadTet& a, const BadTet& b) {
    return std::pair(a.smallest_dihedral_deg, a.tet) < std::pair(b.smallest_dihedral_deg, b.tet);
  };
  std::vector<BadTet>& worst = quality.worst_tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Vec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = mesh.nodes[mesh.tets[t][k]];
    double longest = 0;
    for (const auto& e : kTetEdges) {
      edges.push_back((p[e[0]] - p[e[1]]).norm());
      longest = std::max(longest, edges.back());
    }
    const double v = tet_volume(mesh, t);
    quality.volume += v;
    BadTet tet{t, (p[0] + p[1] + p[2] + p[3]) / 4, 0, -1, 0};  // inverted: below any angle
    if (v > 0) {
      const auto [least, most] = dihedrals(p);
      quality.largest_dihedral_deg = std::max(quality.largest_dihedral_deg, most);
      tet.smallest_dihedral_deg = least;
      tet.radius_edge = radius_edge_ratio(p[0], p[1], p[2], p[3]);
      tet.aspect = aspect_ratio(p, v, longest);
      ratio.push_back(tet.radius_edge);
      smallest.push_back(least);
      aspect.push_back(tet.aspect);
    } else {
      ++quality.inverted;
    }
    if (worst.size() == kWorst && !better(tet, worst.front())) continue;
    if (worst.size() == kWorst) {
      std::pop_heap(worst.begin(), worst.end(), better);
      worst.pop_back();
    }
    worst.push_back(tet);
    std::push_heap(worst.begin(), worst.end(), better);
  }
  std::sort_heap(worst.begin(), worst.end(), better);
  if (!worst.empty()) {
    quality.worst = worst.front().tet;
    quality.worst_place = worst.front().place;
  }
  quality.radius_edge_counts = histogram(ratio, {0.6, 0.7, 0.8, 0.9, 1, 1.2, 1.4, 2, 5});
  quality.dihedral_counts = histogram(smallest, {0, 5, 10, 20, 30, 40, 50, 60});
  quality.aspect_counts = histogram(aspect, {1, 1.5, 2, 3, 4, 6, 10, 100});
  quality.radius_edge = spread(ratio);
  quality.smallest_dihedral_deg = spread(smallest);
  quality.aspect = spread(aspect);
  quality.edge = spread(edges);
  return quality;
}

}  // namespace hapsim
