// What the body's own mesh, of which a deck is made, does to the force under the tool.
#pragma once

#include <string>

#include "exchange/scene.h"

namespace hapsim {

// Stiffness along the normal of the tool's nodes on the body's own mesh over that of the tool on a
// mesh graded to its rim, less one: of a homogeneous linear body with the scene's nu, at the press
// that begins in `row`. Costs some seconds.
double deck_error(const TetMesh& body, const Scene& scene, const Recording& recording, int row);

// A sentence with the nodes and the error; a warning with the mend from 5 % on.
std::string deck_words(const Scene& scene, double error);

}  // namespace hapsim
