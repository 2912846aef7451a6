// A tool that slides over the surface while it presses: palpation of lines, which is no press.
#pragma once

#include <vector>

#include "import/samples.h"

namespace hapsim {

// Whether in most of the rows with contact the tip (position of each row of the table) moves
// sideways, in one contact by at least 3 mm and twice as far as along the mean force. Needs force
// vectors.
bool slides(const std::vector<Vec3>& tip, const Samples& samples, const std::vector<int>& rows);

// Mean direction of the force over the rows with contact, weighted by the force.
Vec3 mean_force_direction(const Samples& samples, const std::vector<int>& rows);

}  // namespace hapsim
