// Contact stiffnesses of a body whose regions relax each in its own way.
#pragma once

#include <functional>
#include <vector>

#include "experiment/extrapolate.h"
#include "model/relaxation_steps.h"

namespace hapsim {

// The stiffnesses at all positions for a material [N/m], each material solved exactly.
using SolveMaterial = std::function<std::vector<Eigen::Matrix3d>(const MaterialSpec&)>;

// Relaxed stiffness and Maxwell elements (PositionStiffness::relaxing) by position, from some
// thirty solutions with moduli along the regions' relaxation: RelaxationSpectrum. `misfit`: what
// the elements leave of the stiffness, the worst position's, relative to it. Error(kBadInput): more
// elements than RelaxationSpectrum takes.
std::vector<PositionStiffness> regional_stiffness(const std::vector<RegionRelaxation>& regions,
                                                  const MaterialSpec& material,
                                                  const SolveMaterial& solve, double& misfit);

}  // namespace hapsim
