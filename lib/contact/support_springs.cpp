#include "contact/support_springs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solid/foundation.h"

namespace hapsim {

namespace {

// Mean settlement of a half-space of unit modulus under a disc of unit area and unit pressure,
// 16 (1 - nu^2)/(3 pi^(3/2)) (Johnson, Contact Mechanics, 1985, 3.4), nu = 0.4.
constexpr double kDiscSettlement = 0.8;

// Share of a triangle's area in which the linear function with these corner values is positive.
struct AreaShare {
  double share = 0;
  std::array<double, 3> by_level{};
};

AreaShare area_beyond(const std::array<double, 3>& level) {
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return level[i] < level[j]; });
  const double low = level[order[0]], mid = level[order[1]], high = level[order[2]];
  if (high <= 0) return {};
  if (low >= 0) return {1, {}};
  AreaShare s;
  // The corner that is alone on its side cuts off the product of two crossings.
  const bool top = mid <= 0;
  const double tip = top ? high : low, far = top ? low : high;
  const double part = tip * tip / ((tip - mid) * (tip - far));
  const double sign = top ? 1 : -1;
  s.share = top ? part : 1 - part;
  s.by_level[order[top ? 2 : 0]] = sign * part * (2 / tip - 1 / (tip - mid) - 1 / (tip - far));
  s.by_level[order[1]] = sign * part / (tip - mid);
  s.by_level[order[top ? 0 : 2]] = sign * part / (tip - far);
  return s;
}

}  // namespace

SupportSprings::SupportSprings(const TetMesh& mesh, const std::vector<double>& value) {
  Foundation foundation;
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Triangle& f : boundary_faces(mesh)) {
    if (!mesh.fixed[f[0]] || !mesh.fixed[f[1]] || !mesh.fixed[f[2]]) continue;
    foundation.faces.push_back(f);
    for (const int n : f) {
      low = low.cwiseMin(mesh.nodes[n]);
      high = high.cwiseMax(mesh.nodes[n]);
    }
  }
  const Vec3 middle = 0.5 * (low + high);
  // A bonded base is a bed so thin that it does not show.
  const double least = 1e-5 * std::cbrt(volume(mesh));
  const double give = value[0];
  const Vec3 along(std::cos(value[1]), std::sin(value[1]), 0);
  const Vec3 across(-along.y(), along.x(), 0);
  const std::vector<FoundationFace> matrices = foundation_faces(mesh, foundation);
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    const Triangle& f = foundation.faces[k];
    std::array<double, 3> level, by_azimuth;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 x = mesh.nodes[f[c]] - middle;
      level[c] = along.dot(x) - value[2];
      by_azimuth[c] = across.dot(x);
    }
    const AreaShare beyond = area_beyond(level);
    double share_by_azimuth = 0, share_by_edge = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      share_by_azimuth += beyond.by_level[c] * by_azimuth[c];
      share_by_edge -= beyond.by_level[c];
    }
    // A spring in series with the body, which yields under a face of this area by `own`: what moves
    // there is y = c/(c + own) of what a free face does, and y, not c nor 1/c, is shared by area.
    // With either of those a face that the edge cuts would move as if all of it were free, or none.
    const double area =
        0.5 *
        (mesh.nodes[f[1]] - mesh.nodes[f[0]]).cross(mesh.nodes[f[2]] - mesh.nodes[f[0]]).norm();
    const double own = kDiscSettlement * std::sqrt(area);
    const double held = least / (least + own), gives = (least + give) / (least + give + own);
    const double y = held + beyond.share * (gives - held);
    const double compliance = own * y / (1 - y), by_y = own / ((1 - y) * (1 - y));
    const double gives_by_give = own / ((least + give + own) * (least + give + own));
    Face face{matrices[k].nodes, matrices[k].by_normal + matrices[k].by_tangential / 3, 0, {}};
    face.spring = 1 / compliance;
    const double by = -by_y / (compliance * compliance);  // of the spring, by y
    face.by_value = {by * beyond.share * gives_by_give, by * (gives - held) * share_by_azimuth,
                     by * (gives - held) * share_by_edge};
    faces.push_back(std::move(face));
  }
}

}  // namespace hapsim
