// Numbers on the nodes and elements of a mesh, for ParaView.
#pragma once

#include <ostream>
#include <vector>

#include "containers/vtu.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// A VTU file, its arrays raw at its end: the mesh with `fixed` and `region`, then what is given,
// one entry a node and an element.
void write_field_vtu(std::ostream& out, const TetMesh& mesh,
                     const std::vector<VtuArray>& point_data,
                     const std::vector<VtuArray>& cell_data);

}  // namespace hapsim
