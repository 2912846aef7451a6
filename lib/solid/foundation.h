// An elastic (Winkler) foundation: the support pushes back in proportion to the displacement.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Traction -k_n (u.n) n - k_t (u - (u.n) n) on the faces, n their undeformed normal (Winkler 1867;
// Hetenyi, Beams on Elastic Foundation, 1946). k -> infinity is bonded, k_t = 0 slides. A layer of
// thickness h and moduli (E, nu) bonded to a rigid base has k_n = E (1 - nu)/((1 + nu)(1 - 2 nu)
// h), k_t = E / (2 (1 + nu) h).
struct Foundation {
  std::vector<Triangle> faces;  // corners, of the mesh's boundary
  double normal = 0;            // k_n [Pa/m]
  double tangential = 0;        // k_t [Pa/m]
};

// One face of it: the consistent matrix over its 3 or 6 nodes, per unit k_n and per unit k_t [m^2].
struct FoundationFace {
  std::vector<int> nodes;
  Eigen::MatrixXd by_normal, by_tangential;
};
// Error(kBadInput) when a face is no face of the mesh or a stiffness is negative.
std::vector<FoundationFace> foundation_faces(const TetMesh& mesh, const Foundation& foundation);

}  // namespace hapsim
