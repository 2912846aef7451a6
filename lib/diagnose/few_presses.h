// A diagnosis of so few presses that their signs cannot tell chance from cause.
#pragma once

#include <vector>

#include "diagnose/candidate.h"
#include "fit/first_parts.h"

namespace hapsim {

struct FewPresses {
  std::vector<Finding> findings;  // with verdicts; those that are missing first, the largest first
  std::vector<Finding> untestable;
  Fit end;                    // with all that is missing
  std::vector<Model> rivals;  // fitted; empty when nothing is ambiguous
};

// Whether what is unseen speaks for an effect that the model (with it) has more: its error falls by
// kForetoldFall, beyond chance, and the effect is told from none.
bool admitted_by_rest(const std::string& effect, const Model& model, const Foretold& before,
                      const Foretold& after, const DiagnoseOptions& options);

// What is left to judge by is the time within the presses: what their first parts foretell of the
// rest (fit/first_parts.h). Sets of up to `gates.most_effects` effects are grown side by side (beam
// search), each addition admitted by that. Sets are ranked by chi-square plus log n a parameter, n
// being the independent samples (integrated autocorrelation time of what the best set leaves;
// quasi-likelihood: Wedderburn, Biometrika 61, 1974). Each effect of the best set is judged again
// on what the set foretells without it, and is ambiguous with any other that can take its place.
// Says nothing of places that were not pressed.
FewPresses diagnose_few_presses(const Baseline& base, const TrialGround& ground,
                                const DiagnoseOptions& options);

}  // namespace hapsim
