// Whether an effect that was found first is still needed beside those found after it.
#pragma once

#include <optional>
#include <string>

#include "diagnose/candidate.h"

namespace hapsim {

// The model without `effect`, refitted, when what remains explains the data as well: the effect
// fails the gates by which it was found. Nothing when it is still needed.
std::optional<Baseline> without_superfluous(const std::string& effect, const Baseline& base,
                                            const TrialGround& ground, const Folds& folds,
                                            const Gates& gates);

}  // namespace hapsim
