// Over which part of a mesh the change of volume is averaged, so that elements do not lock when the
// material is nearly incompressible.
#pragma once

#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// theta = integral of J over the part / its volume; the part's energy is volume * U(theta). The
// pressure is constant a part and condensed out: the unknowns stay displacements, the stiffness
// stays symmetric and positive definite (Simo, Taylor and Pister, Comput. Methods Appl. Mech. Eng.
// 51, 1985; Nagtegaal, Parks and Rice, ibid. 4, 1974).
enum class Dilatation {
  kPointwise,  // theta = J at each point: plain displacement elements; lock as nu tends to 0.5
  kElement,    // one mean a tetrahedron: second order does not lock (P2-P0); first order unchanged
  kPatch,      // one mean a patch of tetrahedra: first order does not lock (F-bar patches: de Souza
               // Neto et al., Int. J. Numer. Methods Eng. 62, 2005)
};

// The patch of every tetrahedron: connected by faces, of one `kind`, about `size` tetrahedra (8 is
// the least that de Souza Neto found free of locking), none below half of it where it can be
// helped. Deterministic. `kind`: one a tetrahedron.
std::vector<int> dilatation_patches(const TetMesh& mesh, const std::vector<int>& kind,
                                    int size = 8);

}  // namespace hapsim
