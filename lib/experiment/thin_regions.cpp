#include "experiment/thin_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hapsim {

std::vector<std::pair<int, double>> thin_regions(const TetMesh& body) {
  constexpr double kSheet = 1.0 / 7;
  constexpr int kCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  if (body.region.empty()) return {};
  std::map<int, double> volume, area;
  std::vector<std::pair<std::array<int, 3>, int>> faces;  // corners ascending, region
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    volume[body.region[t]] += std::abs(tet_volume(body, t));
    for (const auto& c : kCorners) {
      const auto& n = body.tets[t];
      std::array<int, 3> corners{n[c[0]], n[c[1]], n[c[2]]};
      std::sort(corners.begin(), corners.end());
      faces.emplace_back(corners, body.region[t]);
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& [corners, region] = faces[f];
    const bool shared = f + 1 < faces.size() && faces[f + 1].first == corners;
    const int other = shared ? faces[++f].second : region;
    if (shared && other == region) continue;
    const Vec3& a = body.nodes[static_cast<std::size_t>(corners[0])];
    const Vec3 ab = body.nodes[static_cast<std::size_t>(corners[1])] - a,
               ac = body.nodes[static_cast<std::size_t>(corners[2])] - a;
    const double own = ab.cross(ac).norm() / 2;
    area[region] += own;
    if (other != region) area[other] += own;
  }
  std::vector<std::pair<int, double>> thin;
  for (const auto& [region, v] : volume)
    if (const double thickness = 2 * v / area[region];
        region != 0 && thickness < kSheet * std::cbrt(v))
      thin.emplace_back(region, thickness);
  return thin;
}

}  // namespace hapsim
