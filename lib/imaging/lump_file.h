// The lumps of a stiffness image, and what would have been seen, as a table.
#pragma once

#include <ostream>

#include "imaging/stiffness_image.h"

namespace hapsim {

// A row a lump, strongest first, in SI units: x,y,z of its centre, its depth below the surface,
// radius and ratio of its modulus over that around it, each with NAME_low and NAME_high (95 %), and
// `chance` that a body without a lump looks so. No row: none is seen. Comments `# sight: RADIUS
// RATIO DEPTH`: such a ball is found in 95 of 100 with its centre down to there (0: nowhere).
void write_lumps(std::ostream& out, const StiffnessImage& image);

}  // namespace hapsim
