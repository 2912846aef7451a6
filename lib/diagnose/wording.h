// The diagnosis in words that a tired engineer understands.
#pragma once

#include <string>

#include "diagnose/improve.h"
#include "diagnose/measure.h"

namespace hapsim {

// Where the effect acts: the stiff and the soft places, or what its card says of its signature.
std::string describe_where(const Candidate& candidate);
// Sets what the fit says: the evidence (how much of the misfit it takes away), the values with
// uncertainty, and the smallest size that would show.
void describe_fit(const Candidate& candidate, const Measured& measured, const Dataset& dataset,
                  Finding& finding);
// The evidence with the values, or of an effect that is not there the size that would show alone:
// what the data cannot show has no value.
std::string evidence_words(const Finding& finding);
// Where contact points lie off the body's surface; "" where they do not.
std::string shape_words(const Diagnosis& diagnosis);
// With which the words of a complete model's verdict begin.
inline const std::string kNothingMissing =
    "nothing is missing that these data could show above the sizes named with each effect.";
// What is missing and what is left, of forces, torques and points; the steps of a converter, and
// one_kind_words().
std::string explain_verdict(const Diagnosis& diagnosis, const Noise& noise);
// Begins with a space; "" where no three of what is missing are of one kind.
std::string one_kind_words(const Diagnosis& diagnosis);

// A version of an improved model with its errors; `noise` of the force [N].
std::string step_words(const ImprovementStep& step, double noise);
// Why an improvement ended.
std::string end_words(const Improvement& improvement);

}  // namespace hapsim
