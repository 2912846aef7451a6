#include "diagnose/few_presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnose/effect_sets.h"
#include "diagnose/held_out.h"
#include "diagnose/try_effects.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "fit/first_parts.h"

namespace hapsim {
namespace {

constexpr std::size_t kBeam = 3;  // sets that are grown on

// What sets foretell, each once.
class Judge {
 public:
  Judge(const TrialGround& g, const DiagnoseOptions& options)
      : g_(g), options_(options), parts_(first_parts(g.experiment)) {}
  const Foretold& of(const EffectSet& set) {
    const auto known = all_.find(set.added);
    if (known != all_.end()) return known->second;
    return all_
        .emplace(set.added, foretell(set.fitted, g_.experiment, parts_, trial_fit_options(g_)))
        .first->second;
  }
  ForceError error(const EffectSet& set) { return of(set).error(g_.dataset.axes()); }
  // Of no fall, by resampled stretches.
  double chance(const EffectSet& before, const EffectSet& after) {
    return chance_of_no_fall(of(before), of(after), options_.flips, options_.seed);
  }
  // Whether the rest of the presses speaks for what `after` has more.
  bool admits(const std::string& effect, const EffectSet& before, const EffectSet& after) {
    return admitted_by_rest(effect, after.fitted.model, of(before), of(after), options_);
  }

 private:
  const TrialGround& g_;
  const DiagnoseOptions& options_;
  std::vector<FirstParts> parts_;
  std::map<EffectNames, Foretold> all_;
};

const EffectSet& best_set(EffectSets& sets, Judge& judge, const Gates& gates) {
  const EffectSet* best = sets.find({});
  std::vector<const EffectSet*> beam{best};
  for (int level = 0; level < gates.most_effects && !beam.empty(); ++level) {
    std::vector<const EffectSet*> next;
    for (const EffectSet* set : beam)
      for (const Effect* effect : sets.growth(*set))
        if (const EffectSet* grown = sets.grown(*set, *effect);
            grown != nullptr && std::find(next.begin(), next.end(), grown) == next.end() &&
            sets.criterion(*grown) < sets.criterion(*set) - gates.criterion_gain &&
            judge.admits(effect->card().name, *set, *grown))
          next.push_back(grown);
    std::vector<std::pair<double, const EffectSet*>> ranked;
    for (const EffectSet* set : next) ranked.emplace_back(sets.criterion(*set), set);
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (ranked.size() > kBeam) ranked.resize(kBeam);
    if (ranked.empty() || ranked.front().first > sets.criterion(*best) - gates.criterion_gain)
      break;
    best = ranked.front().second;
    beam.clear();
    for (const auto& [criterion, set] : ranked) beam.push_back(set);
  }
  return *best;
}

// What the effect does on top of a set without it.
Finding judged(const Effect& effect, const EffectSet& with_it, const EffectSet& without_it,
               Judge& judge, const TrialGround& g) {
  const Baseline base{without_it.fitted, {}, {}};
  Candidate candidate;
  candidate.effect = &effect;
  candidate.fitted = with_it.fitted;
  candidate.one_more_term = without_it.fitted.model.has(effect.card().name);
  const Yardstick yardstick = make_yardstick(base, {candidate}, g);
  const Measured m = measure(candidate, base, yardstick, g);
  Finding f;
  f.effect = effect.card().name;
  f.one_more_term = candidate.one_more_term;
  f.rmse_now = without_it.fitted.error;
  f.rmse_after = with_it.fitted.error;
  f.held_out_now = judge.error(without_it);
  f.held_out_after = judge.error(with_it);
  f.p_value = judge.chance(without_it, with_it);
  f.criterion_gain = yardstick.residual.squaredNorm() - m.sum_of_squares - m.penalty;
  f.memory = m.memory;
  const double noise = g.allowance.noise * g.allowance.noise;
  const double beyond_noise = f.rmse_now.pooled * f.rmse_now.pooled - noise;
  if (beyond_noise > 0.01 * noise)
    f.share = std::clamp(
        (f.rmse_now.pooled * f.rmse_now.pooled - f.rmse_after.pooled * f.rmse_after.pooled) /
            beyond_noise,
        0.0, 1.0);
  f.where = describe_where(candidate);
  f.evidence = counts_for_nothing(with_it.fitted.model, f.effect);
  f.counts = f.evidence.empty();
  if (f.counts) f.evidence = describe_evidence(candidate, m, f);
  f.next_measurement = effect.card().separated_by;
  return f;
}

bool passes(const Finding& f, const Gates& gates) {
  return f.counts && f.criterion_gain > gates.criterion_gain && f.p_value <= kFewPressesLevel &&
         held_out_fall(f) >= kForetoldFall;
}

struct Member {
  Finding finding;
  const EffectSet* rest;  // the set without it
};

// Of several terms first the effect as a whole, then each further term. The largest first.
std::vector<Member> members_of(const EffectSet& set, EffectSets& sets, Judge& judge,
                               const TrialGround& g) {
  std::vector<Member> members;
  for (std::size_t i = 0; i < set.added.size(); ++i) {
    const std::string& name = set.added[i];
    EffectNames rest = set.added;
    if (i > 0 && set.added[i - 1] == name)
      rest = without(rest, name);
    else
      std::erase(rest, name);
    const EffectSet* found = sets.find_below(rest);
    members.push_back({judged(require_effect(name), set, *found, judge, g), found});
  }
  std::stable_sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
    return a.finding.criterion_gain > b.finding.criterion_gain;
  });
  return members;
}

struct Rival {
  Finding finding;
  Model model;
};

// What can take a member's place.
std::vector<Rival> rivals_of(const Member& member, const EffectSet& best, EffectSets& sets,
                             Judge& judge, const Gates& gates, const TrialGround& g) {
  const Effect& own = require_effect(member.finding.effect);
  std::vector<Rival> rivals;
  for (const Effect* effect : sets.growth(*member.rest)) {
    if (effect == &own || contains(*effect, own.card().name) || contains(own, effect->card().name))
      continue;
    const EffectSet* other = sets.grown(*member.rest, *effect);
    if (other == nullptr || sets.criterion(*other) > sets.criterion(best) + gates.criterion_gain ||
        !judge.admits(effect->card().name, *member.rest, *other))
      continue;
    rivals.push_back({judged(*effect, *other, *member.rest, judge, g), other->fitted.model});
  }
  return rivals;
}

}  // namespace

bool admitted_by_rest(const std::string& effect, const Model& model, const Foretold& before,
                      const Foretold& after, const DiagnoseOptions& options) {
  return counts_for_nothing(model, effect).empty() &&
         after.error(3).pooled <= (1 - kForetoldFall) * before.error(3).pooled &&
         chance_of_no_fall(before, after, options.flips, options.seed) <= kFewPressesLevel;
}

FewPresses diagnose_few_presses(const Baseline& base, const TrialGround& g,
                                const DiagnoseOptions& options) {
  const Gates& gates = options.gates;
  EffectSets sets(base, g, options);
  Judge judge(g, options);
  const EffectSet* best = &best_set(sets, judge, gates);
  FewPresses result;

  std::vector<Member> members = members_of(*best, sets, judge, g);
  while (!members.empty() && !passes(members.back().finding, gates)) {
    best = sets.find_below(without(best->added, members.back().finding.effect));
    members = members_of(*best, sets, judge, g);
  }

  result.end = best->fitted;
  EffectNames settled;
  for (Member& member : members) {
    Finding& f = member.finding;
    f.verdict = Verdict::kMissing;
    settled.push_back(f.effect);
    std::vector<Rival> rivals = rivals_of(member, *best, sets, judge, gates, g);
    for (const Rival& r : rivals) f.confused_with.push_back(r.finding.effect);
    if (!rivals.empty())  // one ambiguous set at a time
      f.verdict = result.rivals.empty() ? Verdict::kIndistinguishable : Verdict::kPossible;
    result.findings.push_back(f);
    if (f.verdict != Verdict::kIndistinguishable) continue;
    result.rivals.push_back(best->fitted.model);
    for (Rival& r : rivals) {
      r.finding.verdict = Verdict::kIndistinguishable;
      r.finding.confused_with = {f.effect};
      for (const Rival& other : rivals)
        if (&other != &r) r.finding.confused_with.push_back(other.finding.effect);
      settled.push_back(r.finding.effect);
      result.findings.push_back(r.finding);
      result.rivals.push_back(r.model);
    }
  }
  for (const Effect* effect : sets.growth(*best)) {
    if (std::find(settled.begin(), settled.end(), effect->card().name) != settled.end()) continue;
    const EffectSet* more = sets.grown(*best, *effect);
    if (more == nullptr) {
      Finding f;
      f.effect = effect->card().name;
      f.rmse_now = f.rmse_after = best->fitted.error;
      f.held_out_now = f.held_out_after = {};
      f.evidence = sets.refusal(*best, *effect);
      f.next_measurement = effect->card().separated_by;
      result.findings.push_back(f);
      continue;
    }
    Finding f = judged(*effect, *more, *best, judge, g);
    f.verdict = f.criterion_gain > gates.criterion_gain && f.share >= gates.share
                    ? Verdict::kPossible
                    : Verdict::kAbsent;
    result.findings.push_back(f);
  }
  for (const Effect* effect : untried(base.fitted.model)) {
    const EffectCard& card = effect->card();
    Finding f;
    f.effect = card.name;
    f.verdict = Verdict::kNotTestable;
    f.evidence = lacking_for(card, g.dataset);
    if (f.evidence.empty() && needs_many_presses(card))
      f.evidence = fmt::format("too few presses: record {} or more", kLeastPresses);
    if (const auto lack = sets.lack().find(card.name); lack != sets.lack().end())
      f.evidence = lack->second;
    if (f.evidence.empty()) {
      if (card.solved && !sets.departs()) result.findings.push_back(ruled_out(*effect, base));
      continue;
    }
    f.next_measurement = f.evidence;
    result.untestable.push_back(f);
  }
  return result;
}

}  // namespace hapsim
