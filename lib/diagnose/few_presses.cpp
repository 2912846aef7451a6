#include "diagnose/few_presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/effect_sets.h"
#include "diagnose/foretold.h"
#include "diagnose/measure.h"
#include "diagnose/try_effects.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "fit/testable.h"

namespace hapsim {
namespace {

constexpr std::size_t kBeam = 3;  // sets that are grown on

// The sets met on the way up. They grow by their criterion alone, as long as one of two levels
// foretells more: an effect may foretell something only beside another.
std::vector<const EffectSet*> search_up(EffectSets& sets, Judge& judge, const Gates& gates) {
  std::vector<const EffectSet*> met{sets.find({})}, beam = met;
  const EffectSet* best = met.front();
  double least = judge.log_error({});
  int in_vain = 0;  // levels that foretell no more than the ones before
  for (int level = 0; level < gates.most_effects && in_vain < 2; ++level) {
    std::vector<const EffectSet*> next;
    for (const EffectSet* set : beam)
      for (const Effect* effect : sets.growth(*set, Kind::kNamed))
        if (const EffectSet* grown = sets.grown(*set, *effect);
            grown != nullptr && std::find(next.begin(), next.end(), grown) == next.end())
          next.push_back(grown);
    std::stable_sort(next.begin(), next.end(), [&](const EffectSet* a, const EffectSet* b) {
      return sets.criterion(*a) < sets.criterion(*b);
    });
    if (next.size() > kBeam) next.resize(kBeam);
    if (next.empty() ||
        sets.criterion(*next.front()) > sets.criterion(*best) - gates.criterion_gain)
      break;
    best = next.front();
    ++in_vain;
    for (const EffectSet* set : next)
      if (const double error = judge.log_error(set->added); error < least)
        least = error, in_vain = 0;
    met.insert(met.end(), next.begin(), next.end());
    beam = std::move(next);
  }
  return met;
}

// What the effect does on top of a set without it.
Finding judged(const Effect& effect, const EffectSet& with_it, const EffectSet& without_it,
               const EffectSets& sets, Judge& judge, const Gates& gates, const TrialGround& g) {
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
  f.criterion_gain = sets.criterion(without_it) - sets.criterion(with_it);
  f.memory = m.memory;
  const double noise = g.allowance.noise * g.allowance.noise;
  const double beyond_noise = f.rmse_now.pooled * f.rmse_now.pooled - noise;
  if (beyond_noise > 0.01 * noise)
    f.share = std::clamp(
        (f.rmse_now.pooled * f.rmse_now.pooled - f.rmse_after.pooled * f.rmse_after.pooled) /
            beyond_noise,
        0.0, 1.0);
  f.where = describe_where(candidate);
  f.held_out_now = judge.error(without_it.added);
  f.held_out_after = {};
  // Only what passes otherwise is learned anew.
  if (f.criterion_gain > gates.criterion_gain) {
    const Foretold foretold = judge.of(without_it.added, with_it.added);
    f.held_out_after = foretold.after;
    f.p_value = foretold.chance();
    f.admitted = judge.admits(foretold);
  }
  describe_fit(candidate, m, g.dataset, f);
  f.next_measurement = effect.card().separated_by;
  return f;
}

struct Member {
  const Effect* effect = nullptr;
  const EffectSet* rest = nullptr;  // the set without it
};

// Of several terms first the effect as a whole, then each further term. The largest gain first.
std::vector<Member> members_of(const EffectSet& set, EffectSets& sets) {
  std::vector<Member> members;
  for (std::size_t i = 0; i < set.added.size(); ++i) {
    const std::string& name = set.added[i];
    EffectNames rest = set.added;
    if (i > 0 && set.added[i - 1] == name)
      rest = without(rest, name);
    else
      std::erase(rest, name);
    members.push_back({&require_effect(name), sets.find_below(rest)});
  }
  std::stable_sort(members.begin(), members.end(), [&](const Member& a, const Member& b) {
    return sets.criterion(*a.rest) > sets.criterion(*b.rest);
  });
  return members;
}

// Whether what is unseen speaks for each of its effects; so it does for none at all.
bool holds(const EffectSet& set, EffectSets& sets, Judge& judge, const Gates& gates,
           const TrialGround& g) {
  const std::vector<Member> members = members_of(set, sets);
  return std::all_of(members.rbegin(), members.rend(), [&](const Member& m) {
    return judged(*m.effect, set, *m.rest, sets, judge, gates, g).admitted;
  });
}

// With further terms of what is there instead of kinds of their own that foretell no more.
const EffectSet* simplified(const EffectSet* set, EffectSets& sets, Judge& judge,
                            const Gates& gates, const TrialGround& g) {
  const std::vector<Member> members = members_of(*set, sets);
  for (auto m = members.rbegin(); m != members.rend(); ++m) {
    if (m->rest->fitted.model.has(m->effect->card().name)) continue;
    for (const std::string& name : m->rest->added) {
      if (!require_effect(name).card().terms) continue;
      const EffectSet* other = sets.find(with(m->rest->added, name));
      if (other != nullptr && other->added.size() == set->added.size() &&
          !judge.admits(judge.of(other->added, set->added)) && holds(*other, sets, judge, gates, g))
        return simplified(other, sets, judge, gates, g);
    }
  }
  return set;
}

// With what is unseen speaking for each addition, the one with the largest gain first.
const EffectSet* grown_on(const EffectSet* set, Kind kind, EffectSets& sets, Judge& judge,
                          const Gates& gates, const TrialGround& g) {
  while (set->added.size() < static_cast<std::size_t>(gates.most_effects)) {
    const EffectSet* best = nullptr;
    for (const Effect* effect : sets.growth(*set, kind)) {
      const EffectSet* more = sets.grown(*set, *effect);
      if (more == nullptr || (best != nullptr && sets.criterion(*more) >= sets.criterion(*best)))
        continue;
      if (judged(*effect, *more, *set, sets, judge, gates, g).admitted &&
          holds(*more, sets, judge, gates, g))
        best = more;
    }
    if (best == nullptr) return set;
    set = best;
  }
  return set;
}

struct Rival {
  Finding finding;
  Model model;
};

// What can take a member's place. A further term comes before a kind of its own.
std::vector<Rival> rivals_of(const Member& member, const EffectSet& best, EffectSets& sets,
                             Judge& judge, const Gates& gates, const TrialGround& g) {
  const Effect& own = *member.effect;
  const Kind kind = own.card().learned ? Kind::kLearned : Kind::kNamed;
  std::vector<Rival> rivals;
  if (member.rest->fitted.model.has(own.card().name)) return rivals;
  for (const Effect* effect : sets.growth(*member.rest, kind)) {
    if (effect == &own || contains(*effect, own.card().name) || contains(own, effect->card().name))
      continue;
    const EffectSet* other = sets.grown(*member.rest, *effect);
    if (other == nullptr || sets.criterion(*other) > sets.criterion(best) + gates.criterion_gain ||
        judge.admits(judge.of(other->added, best.added)))
      continue;
    Finding f = judged(*effect, *other, *member.rest, sets, judge, gates, g);
    if (f.admitted) rivals.push_back({std::move(f), other->fitted.model});
  }
  return rivals;
}

}  // namespace

FewPresses diagnose_few_presses(const Baseline& base, const TrialGround& g,
                                const DiagnoseOptions& options) {
  const Gates& gates = options.gates;
  EffectSets sets(base, g, options);
  Judge judge(base.fitted, g, options);
  std::vector<const EffectSet*> met = search_up(sets, judge, gates);
  std::stable_sort(met.begin(), met.end(), [&](const EffectSet* a, const EffectSet* b) {
    return judge.log_error(a->added) < judge.log_error(b->added);
  });
  const auto all_help = [&](const EffectSet* set) { return holds(*set, sets, judge, gates, g); };
  const EffectSet* best = *std::find_if(met.begin(), met.end(), all_help);
  // Fewer effects that foretell as much, or as many that fit better.
  for (const EffectSet* set : met) {
    const std::size_t size = set->added.size(), now = best->added.size();
    if ((size < now || (size == now && sets.criterion(*set) < sets.criterion(*best))) &&
        !judge.admits(judge.of(set->added, best->added)) && all_help(set))
      best = set;
  }
  best = grown_on(simplified(best, sets, judge, gates, g), Kind::kNamed, sets, judge, gates, g);
  best = simplified(best, sets, judge, gates, g);
  const bool learning = !left_over(best->fitted, g).noise_alone();
  if (learning) best = grown_on(best, Kind::kLearned, sets, judge, gates, g);
  FewPresses result;
  result.end = best->fitted;
  result.held_out = judge.error({});
  result.held_out_end = judge.error(best->added);
  EffectNames settled;
  for (const Member& member : members_of(*best, sets)) {
    Finding f = judged(*member.effect, *best, *member.rest, sets, judge, gates, g);
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
  std::vector<const Effect*> others = sets.growth(*best, Kind::kNamed);
  if (learning)
    for (const Effect* effect : sets.growth(*best, Kind::kLearned)) others.push_back(effect);
  for (const Effect* effect : others) {
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
    Finding f = judged(*effect, *more, *best, sets, judge, gates, g);
    f.verdict = f.criterion_gain > gates.criterion_gain && f.share >= gates.share
                    ? Verdict::kPossible
                    : Verdict::kAbsent;
    result.findings.push_back(f);
  }
  for (const Effect* effect : untried(base.fitted.model, Kind::kNamed, options.unknown)) {
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
