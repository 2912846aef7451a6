// Sizes from which a diagnosis says that effects would show.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnose.h"
#include "summary.h"
#include "truths.h"

namespace hapsim::bench {

// The strength at which the first parameter of what is hidden is as far from what does nothing as
// the diagnosis of a body without it says that would show; negative: nothing is said, or the truth
// moves another parameter, or no strength does.
double strength_that_shows(const Truth& truth, const Model& base, const Diagnosis& of_nothing);

// To standard output: by truth and over all, how many of those sizes are named (half of them, where
// what is said is right).
void print_shown(const std::vector<Trial>& trials);

}  // namespace hapsim::bench
