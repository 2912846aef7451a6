#include "tetmesh/given_mesh.h"

#include <algorithm>

#include "base/error.h"
#include "tetmesh/curve_edges.h"

namespace hapsim {

TetMesh body_of_mesh(TetMesh mesh, bool keep_fixed, const BodyOptions& options,
                     const std::string& where) {
  if (!keep_fixed) {
    const auto bonded = bonded_faces(mesh.nodes, mesh.faces, options.support);
    if (bonds_faces(options.support) && std::count(bonded.begin(), bonded.end(), 1) == 0)
      fail_input(where, "no boundary triangle lies where the support is",
                 "give --fixed below:Z, plane:Z or box:... in metres");
    fix_faces(mesh, bonded);
    fix_named_nodes(mesh, options.support, where);
  }
  if (options.order == 2) mesh = to_second_order(mesh);
  if (!options.curved_to.faces.empty()) curve_edges(mesh, options.curved_to);
  return mesh;
}

}  // namespace hapsim
