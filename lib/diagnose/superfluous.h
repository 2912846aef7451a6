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

// Whether `effect` of `base` passes those gates beside `lesser`, which is held out with it.
bool is_needed(const Effect& effect, const Baseline& base, const Baseline& lesser,
               const TrialGround& ground, const Folds& folds, const Gates& gates);
// So much that the model lacks something: only others are worth the refits of the folds.
bool errs_plainly_more(const Fit& fitted, const Baseline& base);

}  // namespace hapsim
