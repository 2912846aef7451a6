// A surface under tension: what it does to small displacements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// One face of it: the consistent matrix over its 3 or 6 nodes per unit tension, n n' int grad_s N_a
// . grad_s N_b dA with n the face's normal: what the slope of the displacement across the surface
// costs. Displacements along it cost nothing but at its border (Gurtin and Murdoch, Arch. Ration.
// Mech. Anal. 57, 1975), as long as the tension does not change with them.
struct MembraneFace {
  std::vector<int> nodes;
  Eigen::MatrixXd matrix;
};
// Error(kBadInput) when a face is no face of the mesh.
std::vector<MembraneFace> membrane_faces(const TetMesh& mesh, const std::vector<Triangle>& faces);

// Boundary faces that are not bonded.
std::vector<MembraneFace> free_membrane(const TetMesh& mesh);

}  // namespace hapsim
