// One second-order mesh of a whole body, as coarse all over.
#pragma once

#include "tetmesh/contact_mesh.h"

namespace hapsim {

// With edges about `edge` [m] on the surface, finer where it bends; bonded as the base is. Same
// input, same bytes; thread-safe. Error(kBadInput) when it cannot be meshed.
TetMesh make_even_mesh(const ContactBase& base, double edge);

}  // namespace hapsim
