#include "diagnose/beside_rivals.h"

#include <algorithm>

#include "diagnose/held_out.h"
#include "diagnose/measure.h"
#include "diagnose/wording.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

// The names that a branch found beside its rival and what was known before.
std::vector<std::string> found_beside(const Branch& branch, const std::string& rival,
                                      const Diagnosis& before) {
  std::vector<std::string> names;
  for (const Finding& f : branch.d.findings) {
    const bool known = std::any_of(before.findings.begin(), before.findings.end(),
                                   [&](const Finding& k) { return k.effect == f.effect; });
    const bool again = std::find(names.begin(), names.end(), f.effect) != names.end();
    if (f.verdict == Verdict::kMissing && f.effect != rival && !known && !again)
      names.push_back(f.effect);
  }
  return names;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

BesideRivals beside_rivals(const Round& round, const std::vector<std::size_t>& rivals,
                           const Baseline& base, const Diagnosis& d, const TrialGround& g,
                           const Folds& folds, const DiagnoseOptions& options,
                           const std::function<void(Branch&)>& go_on) {
  BesideRivals found;
  for (const std::size_t k : rivals) {
    options.tell("beside " + round.findings[k].effect);
    Branch branch{make_baseline(round.candidates[k].fitted.model, g, folds), d};
    Finding first = round.findings[k];
    first.verdict = Verdict::kMissing;
    for (const std::size_t other : rivals)
      if (other != k) first.confused_with.push_back(round.findings[other].effect);
    branch.d.findings.push_back(first);
    go_on(branch);
    Candidate end = round.candidates[k];
    end.fitted = branch.base.fitted;
    end.held_out = held_out_for(*end.effect, branch.base);
    found.ends.candidates.push_back(std::move(end));
    found.branches.push_back(std::move(branch));
  }
  const Yardstick yardstick = make_yardstick(base, found.ends.candidates, g);
  for (std::size_t b = 0; b < rivals.size(); ++b) {
    const Candidate& end = found.ends.candidates[b];
    const Measured m = measure(end, base, yardstick, g);
    Finding f = round.findings[rivals[b]];
    f.rmse_after = end.fitted.error;
    f.held_out_after = end.held_out.error;
    f.criterion_gain = m.criterion_gain;
    f.memory = m.memory;
    f.values.clear();
    if (end.fitted.model.has(f.effect)) describe_fit(end, m, g.dataset, f);
    found.ends.findings.push_back(f);
  }
  const bool can_hold_out = !folds.held_out.empty();
  found.best = best_of(found.ends, options.gates, can_hold_out);
  if (found.best == rivals.size()) found.best = 0;
  found.rivals = rivals_of(found.best, found.ends, options.gates, can_hold_out, g.allowed_error());
  const auto superfluous = [&](std::size_t b) {
    return !found.ends.candidates[b].fitted.model.has(found.ends.findings[b].effect);
  };
  std::erase_if(found.rivals, superfluous);
  if (superfluous(found.best)) found.rivals.clear();  // neither it nor they are asked for
  return found;
}

void take_what_is_shared(const BesideRivals& found, const TrialGround& g, const Folds& folds,
                         Baseline& base, Diagnosis& d) {
  const Diagnosis before = d;
  const std::string& best = found.ends.findings[found.best].effect;
  std::vector<std::string> shared = found_beside(found.branches[found.best], best, before), some;
  for (const std::size_t b : found.rivals) {
    const std::vector<std::string> there =
        found_beside(found.branches[b], found.ends.findings[b].effect, before);
    std::erase_if(shared, [&](const std::string& name) {
      if (has(there, name)) return false;
      if (!has(some, name)) some.push_back(name);
      return true;
    });
    for (const std::string& name : there)
      if (!has(shared, name) && !has(some, name)) some.push_back(name);
  }
  Model model = found.branches[found.best].base.fitted.model;
  remove_effect(model, best);
  for (const std::string& name : some)
    if (model.has(name)) remove_effect(model, name);
  if (!shared.empty()) base = make_baseline(model, g, folds);
  // With all of its terms, from the first branch that has it.
  const auto add = [&](const std::string& name, Verdict verdict) {
    for (std::size_t b = 0; b < found.branches.size(); ++b) {
      const std::size_t listed = d.findings.size();
      for (Finding f : found.branches[b].d.findings) {
        if (f.effect != name || f.verdict != Verdict::kMissing) continue;
        f.verdict = verdict;
        if (verdict == Verdict::kPossible) f.beside = found.ends.findings[b].effect;
        d.findings.push_back(f);
      }
      if (d.findings.size() > listed) return;
    }
  };
  for (const std::string& name : shared) add(name, Verdict::kMissing);
  for (const std::string& name : some) add(name, Verdict::kPossible);
}

}  // namespace hapsim
