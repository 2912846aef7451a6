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
// What `effect` contains as a special case in its place, the first of the card's list beside which
// `effect` fails those gates. Nothing when it is needed as it is; not of maps, nor of what is
// learned, which states no cause.
std::optional<Simpler> simpler_in_place(const std::string& effect, const Baseline& base,
                                        const TrialGround& ground, const Folds& folds,
                                        const Gates& gates);

}  // namespace hapsim
