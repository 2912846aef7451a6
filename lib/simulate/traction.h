// Traction control: the forces on the tool are given, and its displacements are found.
#pragma once

#include <vector>

#include "experiment/forces.h"

namespace hapsim {

// The tool's displacement at every row of the recording, for the recording's forces (of the body on
// the tool) [m]: the inverse of model_forces(), exact step by step. With a and c of memory_step(),
//   (K + sum_j c_j K_j) u = -f - sum_j K_j (a_j h_j - c_j u_before),
// K_j = share_j K for Maxwell elements of the whole body, those of PositionStiffness::relaxing
// where regions relax each in its own way. In the air the displacement is zero. Error(kBadInput):
// the model has an effect that is neither of these nor part of the stiffness.
std::vector<Vec3> displacements_of_forces(const Model& model, const Dataset& dataset,
                                          const StiffnessAt& stiffness_at);

// The same on contact meshes and on the body's own mesh: the recording with these displacements.
Recording with_displacements(const Model& model, const Dataset& dataset,
                             const StiffnessAt& stiffness_at);

}  // namespace hapsim
