// Whether an effect that was found first is still needed beside those found after it.
#pragma once

#include <optional>
#include <string>

#include "diagnose/candidate.h"
#include "diagnose/measure.h"

namespace hapsim {

// The model without `effect`, refitted, when what remains explains the data as well: the effect
// fails the gates by which it was found. Nothing when it is still needed.
std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            const TrialGround& ground, const Folds& folds,
                                            const Gates& gates);

struct Simpler {
  Candidate candidate;
  Measured measured;  // beside the model without either
  Baseline base;
};
// What `effect` contains as a special case in its place, the simplest beside which `effect` fails
// those gates; not `unknown`. Nothing when it is needed as it is; not of maps and fields.
std::optional<Simpler> simpler_in_place(const std::string& effect, const std::string& unknown,
                                        const Baseline& base, const TrialGround& ground,
                                        const Folds& folds, const Gates& gates);

}  // namespace hapsim
