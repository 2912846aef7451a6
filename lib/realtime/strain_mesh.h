// The elements that samples of large strain are solved by, and how far finer ones are from them.
#pragma once

#include "contact/contact_stiffness.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "realtime/strain_sample.h"
#include "simulate/full_simulation.h"

namespace hapsim {

// Of half a radius at the rim, with straight edges, or `finer` times as large. `base` must outlive
// them.
FullOptions strain_elements(const ContactBase& base, double finer = 1);

// By how much elements two thirds as large differ in the force over the linear stiffness, relative
// to it, the larger of straight down and of half of strain_side() aside; 0.2 at least from where
// they do not converge. Where the surface folds beside the tool, as of a Neo-Hookean block from
// one radius or so on, meshes fold each in its way, and differ by 4 to 17 % at 30 % of the
// thickness (s = 0.2: 0.9 %).
StrainMeshError strain_mesh_error(const TetMesh& body, const ContactBase& base, const Model& model,
                                  const StrainSample& sample, double tool_radius);

}  // namespace hapsim
