// One round of a diagnosis: every effect that a model lacks, tried on top of it.
#pragma once

#include <vector>

#include "base/random.h"
#include "diagnose/candidate.h"

namespace hapsim {

struct Round {
  std::vector<Candidate> candidates;
  std::vector<Finding> findings;   // one a candidate, same order
  std::vector<Finding> ruled_out;  // without a fit
  std::vector<Finding> untestable;
};

// What a round tries: effects that have a name, or curves of no law (EffectCard::learned).
enum class Kind { kNamed, kLearned };
// Another law of what Maxwell elements do, which is tried in their place once they were found: that
// there is a memory at all every such law tells.
bool refines_relaxation(const Effect& effect);
// Effects worth trying on top of a model: those it lacks, and one more term of those with terms;
// never `unknown` (DiagnoseOptions).
std::vector<const Effect*> untried(const Model& model, Kind kind, const std::string& unknown);
// Whether `effect` includes the effect `other` as a special case.
bool contains(const Effect& effect, const std::string& other);
// Whether one of the two includes the other.
bool related(const Effect& a, const Effect& b);

// An effect that needs no fit: no position asks for another stiffness.
Finding ruled_out(const Effect& effect, const Baseline& base);

// Estimates every effect, solves for the promising ones, and measures them all alike. Findings have
// no verdict yet.
Round try_all(Kind kind, const Baseline& base, const TrialGround& ground, const Folds& folds,
              const DiagnoseOptions& options, Random& random);

}  // namespace hapsim
