// Parts of a recording: some of its positions, or the beginnings of its presses.
#pragma once

#include <vector>

#include "experiment/dataset.h"

namespace hapsim {

// Of some positions alone, in ascending order; the rows and presses of the others are left out.
Dataset at_positions(const Dataset& dataset, const std::vector<std::size_t>& positions);

// Of each episode its first so many samples, one count an episode; positions stay as they are.
// Episodes of which nothing is left are left out.
Dataset beginnings(const Dataset& dataset, const std::vector<std::size_t>& samples);

}  // namespace hapsim
