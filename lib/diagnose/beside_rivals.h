// Rivals of a round that leave more than noise: what else is missing is looked for beside each of
// them, and may tell them apart.
#pragma once

#include <functional>
#include <vector>

#include "diagnose/round_winner.h"

namespace hapsim {

// A search that went on from the model with one of the rivals.
struct Branch {
  Baseline base;
  Diagnosis d;
};

struct BesideRivals {
  // One a rival, in the order in which they were given.
  std::vector<Branch> branches;
  // The round of the rivals alone, each as its branch ended.
  Round ends;
  std::size_t best = 0;
  // That still do as well as the best; none where what was found beside it made it superfluous.
  std::vector<std::size_t> rivals;
};

// `go_on` searches from a branch's model to its end; `base` and `d` are those of the round.
BesideRivals beside_rivals(const Round& round, const std::vector<std::size_t>& rivals,
                           const Baseline& base, const Diagnosis& d, const TrialGround& ground,
                           const Folds& folds, const DiagnoseOptions& options,
                           const std::function<void(Branch&)>& go_on);

// What was found beside each of those that are left is missing whichever of them is: it stands in
// `base` and `d` as such. What was found beside some of them only is possible.
void take_what_is_shared(const BesideRivals& found, const TrialGround& ground, const Folds& folds,
                         Baseline& base, Diagnosis& d);

}  // namespace hapsim
