// A mesh of tetrahedra from elsewhere as a body.
#pragma once

#include <string>

#include "tetmesh/body_mesh.h"

namespace hapsim {

// Its tetrahedra as they are: fixed where options.support says (`keep_fixed`: where it says
// itself), of the second order where that is asked, laid on options.curved_to where there is one.
// Error(kBadInput) beginning with `where`: no boundary triangle lies where the support is.
TetMesh body_of_mesh(TetMesh mesh, bool keep_fixed, const BodyOptions& options,
                     const std::string& where);

}  // namespace hapsim
