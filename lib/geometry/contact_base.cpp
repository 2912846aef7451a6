// The surface from which all contact meshes of a body start.
#include <cmath>

#include "geometry/coarsen.h"
#include "geometry/contact_mesh.h"
#include "geometry/tetgen.h"

namespace hapsim {

ContactBase make_contact_base(const TetMesh& body, double edge) {
  std::vector<int> node;
  ClassedSurface fine;
  fine.surface = boundary_surface(body, &node);
  check_surface(fine.surface, "the body's boundary");
  if (!(edge > 0)) edge = std::cbrt(3 * signed_volume(fine.surface)) / 9;
  for (const Triangle& f : fine.surface.faces)
    fine.face_class.push_back(body.fixed[node[f[0]]] && body.fixed[node[f[1]]] &&
                              body.fixed[node[f[2]]]);
  ClassedSurface coarse = coarsen_surface(fine, [edge](const Vec3&) { return edge; });
  coarse = split_long_edges(coarse, [edge](const Vec3&) { return 1.6 * edge; });
  return {std::move(coarse.surface), std::move(coarse.face_class), std::move(fine.surface)};
}

}  // namespace hapsim
