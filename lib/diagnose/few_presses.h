// A diagnosis of so few presses that their signs cannot tell chance from cause.
#pragma once

#include <vector>

#include "diagnose/candidate.h"

namespace hapsim {

struct FewPresses {
  std::vector<Finding> findings;  // with verdicts; those that are missing first, the largest first
  std::vector<Finding> untestable;
  Fit end;                            // with all that is missing
  std::vector<Model> rivals;          // fitted; empty when nothing is ambiguous
  ForceError held_out, held_out_end;  // on what was unseen, without and with what is missing
};

// What is left to judge by is the time within the presses: what came first has to foretell the rest
// (diagnose/foretold.h), and presses left out as far as there are several. Sets of up to
// `gates.most_effects` effects are grown side by side (beam search), since one large effect hides
// another where no second press shows it alone; each addition must help there. Sets are ranked by
// chi-square plus log n a parameter, n being the independent samples (integrated autocorrelation
// time of what the best set leaves; quasi-likelihood: Wedderburn, Biometrika 61, 1974). Each effect
// of the best set is judged again on what the set foretells without it, and is ambiguous with any
// other that can take its place. Says nothing of places that were not pressed.
FewPresses diagnose_few_presses(const Baseline& base, const TrialGround& ground,
                                const DiagnoseOptions& options);

}  // namespace hapsim
