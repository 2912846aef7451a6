// Tractions on a body's surface as nodal forces.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Consistent nodal forces (3 nodes) [N] of a traction [Pa] that is constant on each of `faces`
// (corners of boundary faces, outward), integral of N_a t dA over flat faces: a third of the area
// to each corner (order 1) or to each middle (order 2).
Eigen::VectorXd traction_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              const Vec3& traction);
// The same of a pressure [Pa] against the undeformed normal.
Eigen::VectorXd pressure_load(const TetMesh& mesh, const std::vector<Triangle>& faces,
                              double pressure);

}  // namespace hapsim
