#include "fem/support_springs.h"

#include <algorithm>
#include <cmath>

#include "fem/foundation.h"

namespace hapsim {

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
    const Vec3 centre = (mesh.nodes[f[0]] + mesh.nodes[f[1]] + mesh.nodes[f[2]]) / 3 - middle;
    // How far the face reaches from its centre along the azimuth, and as that turns.
    double reach = 1e-9, reach_by_azimuth = 0;
    for (const int n : f) {
      const Vec3 arm = mesh.nodes[n] - middle - centre;
      if (std::abs(along.dot(arm)) <= reach) continue;
      reach = std::abs(along.dot(arm));
      reach_by_azimuth = (along.dot(arm) > 0 ? 1 : -1) * across.dot(arm);
    }
    // The share beyond the edge rises linearly while the edge crosses the face.
    const double level = along.dot(centre) - value[2];
    const double share = std::clamp(0.5 + level / (2 * reach), 0.0, 1.0);
    const bool cut = share > 0 && share < 1;
    const double by_level = cut ? 1 / (2 * reach) : 0;
    const double by_azimuth = by_level * (across.dot(centre) - level / reach * reach_by_azimuth);
    Face face{matrices[k].nodes, matrices[k].by_normal + matrices[k].by_tangential / 3, 0, {}};
    const double compliance = least + give * share;
    face.spring = 1 / compliance;
    const double by_share = -give / (compliance * compliance);
    face.by_value = {-share / (compliance * compliance), by_share * by_azimuth,
                     -by_share * by_level};
    faces.push_back(std::move(face));
  }
}

}  // namespace hapsim
