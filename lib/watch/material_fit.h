// How a body's material has changed, from presses on it.
#pragma once

#include "watch/corrected_model.h"

namespace hapsim {

// Into `c`, the rest of which stays: the factor of all moduli, in closed form. False where hardly
// any stiffness is left.
bool fit_stiffness(const PreparedBody& body, const SurfaceOffsets& offsets,
                   const std::vector<WatchedSample>& window, Correction& c);
// Stiffness, moduli and times of what relaxes: the moduli in closed form, the factor of the times
// by a grid and golden sections. False where the window does not tell.
bool fit_relaxation(const PreparedBody& body, const SurfaceOffsets& offsets,
                    const std::vector<WatchedSample>& window, Correction& c);

}  // namespace hapsim
