// Gains of bins as sentences a person reads.
#pragma once

#include <string>

#include "compare/breakdown.h"

namespace hapsim {

// "too stiff by 18 %", "too soft by 3 %", or "right (within 2 %)" when the gain is not told from 1.
std::string stiffness_words(const BinError& error);
bool right_on_the_whole(const BinError& error);

std::string sentence_overall(const BinError& error);

// Names the two bins that differ most, in the order of the bins; empty when there are not two.
std::string sentence_of_bins(const Grouping& grouping, const std::vector<BinError>& errors);

}  // namespace hapsim
