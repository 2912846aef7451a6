// A surface under tension: what it does to small displacements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// One face of it: the consistent matrix over its 3 or 6 nodes per unit tension [N/m over N/m],
// int grad_s N_a . grad_s N_b dA for each direction of displacement: the initial-stress stiffness
// of an isotropic membrane stress (Zienkiewicz and Taylor, The Finite Element Method, vol. 2).
struct MembraneFace {
  std::vector<int> nodes;
  Eigen::MatrixXd matrix;
};
// Error(kBadInput) when a face is no face of the mesh.
std::vector<MembraneFace> membrane_faces(const TetMesh& mesh, const std::vector<Triangle>& faces);

// Boundary faces that are not bonded.
std::vector<MembraneFace> free_membrane(const TetMesh& mesh);

}  // namespace hapsim
