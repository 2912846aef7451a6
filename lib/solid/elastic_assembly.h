// The stiffness of an isotropic linear elastic mesh, into a sparse system of its free nodes.
#pragma once

#include <vector>

#include "solid/elasticity.h"
#include "solid/node_system.h"

namespace hapsim {

// One clique a tetrahedron, in the mesh's order.
Cliques element_cliques(const TetMesh& mesh);

// An element's stiffness, node by node (3 nodes squared) [N/m].
Eigen::MatrixXd element_matrix(const TetMesh& mesh, std::size_t tet, const Lame& constants,
                               Dilatation dilatation);

// Clears `system`, whose first cliques are element_cliques(mesh), and fills it for one pair of
// Lame's constants an element [Pa].
void assemble_elastic(NodeSystem& system, const TetMesh& mesh, const std::vector<Lame>& lame_of_tet,
                      Dilatation dilatation);

}  // namespace hapsim
