// Surfaces cut by a plane and made of even triangles.
#pragma once

#include <limits>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// What of a closed surface lies above the height z, closed by a flat face whose vertices have
// exactly that z. Error(kNoConvergence) when the surface cuts itself, or nothing is left.
Surface cut_flat(const Surface& surface, double z);

struct RemeshOptions {
  double edge = 0;  // wished edge length [m]
  int rounds = 5;
  // Height of a flat bottom, kept exactly flat with its rim; NaN: none.
  double base = std::numeric_limits<double>::quiet_NaN();
  double crease_deg = 180;  // edges with a sharper turn are kept as lines
};

// Isotropic remeshing (Botsch, Kobbelt 2004): split, collapse, flip, relax, project. The surface
// stays closed; its vertices lie on the old one.
Surface remesh(const Surface& surface, const RemeshOptions& options);
// The same; seams between faces of different labels are kept as lines, and new faces have the label
// of those they lie on. `label`: one a face.
Surface remesh(const Surface& surface, const RemeshOptions& options, std::vector<int>& label);

}  // namespace hapsim
