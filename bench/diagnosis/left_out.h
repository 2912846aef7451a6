// Trials whose hidden effect was taken from the catalogue: an open world.
#pragma once

#include <string>
#include <vector>

#include "summary.h"
#include "truths.h"

namespace hapsim::bench {

// One hidden effect on the plain body, all presses.
bool can_be_left_out(const Truth& truth);

// Whether a curve of no law is of the kind of what is hidden.
bool is_of_kind(const std::string& hidden, const std::string& learned);

// To standard output: what was said of each, and how often; the kinds are those of the cards
// (EffectCard::kinds)
//   kind    no cause is named, and its kind is said or its curve learned
//   open    no cause is named, and no kind or another is said
//   set     effects that look alike, one of them first of all of its kind
//   hedged  something else is named, and it is said that more is left
//   same    something else is named, and foretells unseen places to the floor: the same force
//   kin     something else is named, clear, and does not, of which all is of its kind
//   sure    something else is named, clear, and does not, of another kind
//   unseen  called complete
void print_left_out(const std::vector<Trial>& trials);

}  // namespace hapsim::bench
