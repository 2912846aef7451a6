// One candidate effect: fitted, and held out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hapsim {

// A fitted model that candidates are compared against.
struct Baseline {
  Fit fitted;
  HeldOut held_out;      // any map made anew
  HeldOut on_known_map;  // what effects that make no map are compared with
};

// On which the effect is judged by unseen positions.
inline const HeldOut& held_out_for(const Effect& effect, const Baseline& base) {
  return effect.card().is_map ? base.held_out : base.on_known_map;
}

struct Candidate {
  const Effect* effect = nullptr;
  Fit fitted;
  std::vector<Model> starts;  // of the estimate, where finite elements are solved for it
  HeldOut held_out;
  bool one_more_term = false;
  bool every_site = false;  // of regions: each position its own, interpolated between them
};

Baseline make_baseline(const Model& model, const TrialGround& ground, const Folds& folds);
// Without `effect` and all of its terms, refitted.
Baseline without_effect(const std::string& effect, const Baseline& base, const TrialGround& ground,
                        const Folds& folds);
// Whether an effect is worth a fit: of one that is `screened`, whether what its starts change and
// their derivatives, in any proportion, take away half of what its parameters cost (the information
// criterion's log n each) from the residual. Costs one evaluation a start; chance takes some 1 a
// parameter.
bool worth_a_fit(const Effect& effect, const Baseline& baseline, const TrialGround& ground);
inline constexpr const char* kTakesNothing =
    "nothing like what it would change is in what the model leaves";
// Fitted from all its starts; nothing when the data cannot test it (`lack` says why).
std::optional<Candidate> try_effect(const Effect& effect, const Baseline& baseline,
                                    const TrialGround& ground, std::string& lack);
// Fits with finite elements solved what was fitted by estimates.
void refine(Candidate& candidate, const TrialGround& ground);
// Its error on held-out positions: with any map made anew if the effect is one, else with the map
// kept (see held_out_for()).
void hold_out(Candidate& candidate, const TrialGround& ground, const Folds& folds);
// For a map only. Regions with boundaries suit a stiffness that jumps; where it changes gradually,
// a modulus at each position with interpolation between them predicts unseen positions better.
// Takes the latter where its unseen error is much smaller, unless boundaries already leave the
// pressed positions noise alone.
void prefer_sites(Candidate& candidate, const Baseline& baseline, const TrialGround& ground,
                  const Folds& folds);

}  // namespace hapsim
