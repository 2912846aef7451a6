// How sure each statement on an effect is.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hapsim {

// Share of the first among effects that were tried beside each other, by their gains of the
// criterion: exp(gain / (2 T m)) of each over their sum, m samples to an independent one. The
// likelihoods are tempered (T): the forms of all of them err, and what they err by grows with the
// samples and is none of the noise.
double share_among(const Finding& first, const std::vector<const Finding*>& others);

// Sets Finding::probability: that the effect acts (of a curve of no law, that the cause is of its
// kind), NaN where it was not tested. One of a set that cannot be told apart has its share of what
// such sets hold; what was found beside one of them alone has that one's as well; the others have
// what verdicts like theirs were worth in the trials of bench/diagnosis, in which each was drawn as
// often as any other: a user who knows better knows better.
void set_probabilities(Diagnosis& d);

// For --help and the man page.
std::string probability_in_words();

}  // namespace hapsim
