// Bodies of tetrahedra as hapsim writes and reads them.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "io/stream.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// Body PLY: vertex (x y z, uchar fixed), face, tetrahedron (list of 4 or 10, int region).
// Error(kBadInput): index out of range, inverted or degenerate tetrahedron (its number and place),
// no tetrahedra, a part of the body that fixed nodes do not hold.
// `window`: the outline of what was seen of the body (mesh/window.h); empty: all of it.
TetMesh read_body(Input& input, std::vector<Vec3>* window = nullptr);
void write_body_ply(std::ostream& out, const TetMesh& mesh, bool ascii = false,
                    const std::vector<std::string>& comments = {});
void write_body_vtu(std::ostream& out, const TetMesh& mesh);

}  // namespace hapsim
