// The diagnosis in words that a tired engineer understands.
#pragma once

#include <string>

#include "diagnose/candidate.h"
#include "diagnose/improve.h"

namespace hapsim {

// Where the effect acts: the stiff and the soft places, or what its card says of its signature.
std::string describe_where(const Candidate& candidate);
// How much of the misfit it takes away, and its fitted size with uncertainty.
std::string describe_evidence(const Candidate& candidate, const Measured& measured,
                              const Finding& finding);
std::string describe_verdict(const Diagnosis& diagnosis, bool structure_left);

// A version of an improved model with its errors; `noise` of the force [N].
std::string step_words(const ImprovementStep& step, double noise);
// Why an improvement ended.
std::string end_words(const Improvement& improvement);

}  // namespace hapsim
