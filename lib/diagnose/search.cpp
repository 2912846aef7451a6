#include "diagnose/search.h"

#include <algorithm>
#include <array>

#include "diagnose/beside_rivals.h"
#include "diagnose/held_out.h"
#include "diagnose/in_place.h"
#include "diagnose/left_over.h"
#include "diagnose/one_size.h"
#include "diagnose/probability.h"
#include "diagnose/rivals_together.h"
#include "diagnose/round_winner.h"
#include "diagnose/superfluous.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

// What is done where a round ends in rivals: it is the end, or the search goes on beside each.
enum class Rivals { kEnd, kGoOn };

// What was found first may have stood for what was found after it.
void drop_superfluous(Baseline& base, const TrialGround& g, const Folds& folds,
                      const DiagnoseOptions& options, Diagnosis& d) {
  for (std::size_t k = 0; k + 1 < d.findings.size();) {
    const Finding& earlier = d.findings[k];
    // Of a map that a later one includes nothing can be taken away by itself.
    const bool is_map = require_effect(earlier.effect).card().is_map;
    const bool repeated =
        std::any_of(d.findings.begin() + static_cast<std::ptrdiff_t>(k) + 1, d.findings.end(),
                    [&](const Finding& f) {
                      return f.effect == earlier.effect ||
                             (is_map && contains(require_effect(f.effect), earlier.effect));
                    });
    if (repeated || !base.fitted.model.has(earlier.effect)) {
      ++k;
      continue;
    }
    options.tell("without " + earlier.effect);
    auto lesser = without_superfluous(earlier.effect, base, g, folds, options.gates);
    if (!lesser) {
      ++k;
      continue;
    }
    base = std::move(*lesser);
    d.findings[k + 1].rmse_now = earlier.rmse_now;
    d.findings[k + 1].held_out_now = earlier.held_out_now;
    Finding& latest = d.findings.back();
    latest.rmse_after = base.fitted.error;
    latest.held_out_after = held_out_for(require_effect(latest.effect), base).error;
    d.findings.erase(d.findings.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

// What was found first may have stood for itself and for more than that, which is named now.
void take_simpler(Baseline& base, const TrialGround& g, const Folds& folds,
                  const DiagnoseOptions& options, Diagnosis& d) {
  for (std::size_t k = 0; k + 1 < d.findings.size(); ++k) {
    Finding& earlier = d.findings[k];
    if (!base.fitted.model.has(earlier.effect) ||
        require_effect(earlier.effect).card().contains.empty())
      continue;
    options.tell("in the place of " + earlier.effect);
    auto simpler = simpler_in_place(earlier.effect, options.unknown, base, g, folds, options.gates);
    if (!simpler) continue;
    base = std::move(simpler->base);
    describe_in_place(*simpler, g.dataset, earlier);
    Finding& latest = d.findings.back();
    latest.rmse_after = base.fitted.error;
    latest.held_out_after = held_out_for(require_effect(latest.effect), base).error;
  }
}

// What the latest includes as a special case has left the model when that came in.
void drop_included(const Baseline& base, Diagnosis& d) {
  for (std::size_t k = 0; k + 1 < d.findings.size();) {
    const Finding earlier = d.findings[k];
    if (base.fitted.model.has(earlier.effect)) {
      ++k;
      continue;
    }
    d.findings[k + 1].rmse_now = earlier.rmse_now;
    d.findings[k + 1].held_out_now = earlier.held_out_now;
    d.findings.erase(d.findings.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

// What was tried on top of the model that the search ended with, and is not in it.
void list_the_rest(const Round& last, const Gates& gates, Diagnosis& d) {
  for (const Finding& f : last.findings) {
    if (f.effect.empty()) continue;
    const bool known = std::any_of(d.findings.begin(), d.findings.end(),
                                   [&](const Finding& other) { return other.effect == f.effect; });
    if (known) continue;
    Finding finding = f;
    const bool by_chance = !f.plain && f.p_value >= gates.p_value;
    if (f.hidden) {
      finding.verdict = Verdict::kNotTestable;
      finding.evidence = finding.next_measurement =
          "a law of the depth and a first touch of each place's own would do the same; record " +
          f.next_measurement;
      d.findings.push_back(finding);
      continue;
    }
    // Another kernel in the place of as many Maxwell elements as the data ask for need not do more
    // than they do.
    const bool in_place = refines_relaxation(require_effect(f.effect)) &&
                          f.rmse_after.pooled <= kAlike * f.rmse_now.pooled;
    finding.verdict = in_place || (f.criterion_gain > gates.criterion_gain && !by_chance &&
                                   f.share >= gates.share)
                          ? Verdict::kPossible
                          : Verdict::kAbsent;
    d.findings.push_back(finding);
  }
}

// Effects that do as well as the round's best, after it; none where it stands alone.
std::vector<std::size_t> best_and_rivals(const Round& round, std::size_t best, const TrialGround& g,
                                         const Gates& gates, bool can_hold_out) {
  std::vector<std::size_t> rivals = rivals_of(best, round, gates, can_hold_out, g.allowed_error());
  const bool next_round_finds_the_other = std::any_of(
      rivals.begin(), rivals.end(),
      [&](std::size_t k) { return both_act(round.candidates[best], round.candidates[k], g); });
  if (rivals.empty() || next_round_finds_the_other) return {};
  rivals.insert(rivals.begin(), best);
  return rivals;
}

// More than can be tried side by side; where these leave more than noise all the same, to name them
// would be to name nothing.
constexpr std::size_t kMostRivals = 3;
bool none_of_many(const Round& round, const std::vector<std::size_t>& rivals,
                  const TrialGround& g) {
  return rivals.size() > kMostRivals &&
         !left_over(round.candidates[rivals.front()].fitted, g).noise_alone();
}

// The data cannot tell them apart.
void list_rivals(const Round& round, const std::vector<std::size_t>& rivals, const TrialGround& g,
                 Diagnosis& d) {
  d.left = left_over(round.candidates[rivals.front()].fitted, g);
  for (const std::size_t k : rivals) {
    d.rivals.push_back(round.candidates[k].fitted.model);
    Finding finding = round.findings[k];
    finding.verdict = Verdict::kIndistinguishable;
    for (const std::size_t other : rivals)
      if (other != k) finding.confused_with.push_back(round.findings[other].effect);
    d.findings.push_back(finding);
  }
}

void search_from(Kind kind, Rivals rivals_may, Baseline& base, const TrialGround& g,
                 const Folds& folds, const DiagnoseOptions& options, Diagnosis& d);

// Goes on beside each of the rivals where they leave more than noise. True where one of them is
// then left: the search is over, and `base` and `d` are its.
bool told_apart(const Round& round, std::vector<std::size_t> rivals, Baseline& base,
                const TrialGround& g, const Folds& folds, const DiagnoseOptions& options,
                Diagnosis& d) {
  if (rivals.size() > kMostRivals ||
      left_over(round.candidates[rivals.front()].fitted, g).noise_alone()) {
    list_rivals(round, rivals, g, d);
    return false;
  }
  const auto go_on = [&](Branch& branch) {
    search_from(Kind::kNamed, Rivals::kEnd, branch.base, g, folds, options, branch.d);
  };
  BesideRivals found = beside_rivals(round, rivals, base, d, g, folds, options, go_on);
  if (found.rivals.empty()) {
    base = std::move(found.branches[found.best].base);
    d = std::move(found.branches[found.best].d);
    return true;
  }
  take_what_is_shared(found, g, folds, base, d);
  for (Finding& f : found.ends.findings) {
    f.rmse_now = base.fitted.error;
    f.held_out_now = held_out_for(require_effect(f.effect), base).error;
  }
  found.rivals.insert(found.rivals.begin(), found.best);
  list_rivals(found.ends, found.rivals, g, d);
  return false;
}

// Adds the best effect while one passes the gates; where no effect that has a name does, and not
// noise alone is left, the best curve of no law. `kind`: what is tried first.
void search_from(Kind kind, Rivals rivals_may, Baseline& base, const TrialGround& g,
                 const Folds& folds, const DiagnoseOptions& options, Diagnosis& d) {
  const bool can_hold_out = !folds.held_out.empty();
  Random random(options.seed);
  std::array<Round, 2> last;  // by Kind
  for (int added = 0; added < options.gates.most_effects;) {
    Round& round = last[static_cast<std::size_t>(kind)];
    round = try_all(kind, base, g, folds, options, random);
    const std::size_t best = best_of(round, options.gates, can_hold_out);
    // Curves state no cause: the best of them stands, and others that pass are told with it.
    const std::vector<std::size_t> rivals =
        best == round.findings.size() || kind == Kind::kLearned
            ? std::vector<std::size_t>{}
            : best_and_rivals(round, best, g, options.gates, can_hold_out);
    if (best == round.findings.size() || none_of_many(round, rivals, g)) {
      if (kind == Kind::kLearned || left_over(base.fitted, g).noise_alone()) break;
      kind = Kind::kLearned;
      continue;
    }
    if (!rivals.empty()) {
      if (rivals_may == Rivals::kEnd)
        list_rivals(round, rivals, g, d);
      else if (told_apart(round, rivals, base, g, folds, options, d))
        return;
      break;
    }
    Finding finding = round.findings[best];
    finding.verdict = Verdict::kMissing;
    std::vector<const Finding*> beside;
    for (std::size_t k = 0; k < round.findings.size(); ++k) {
      if (k == best || !passes(round.findings[k], options.gates, can_hold_out)) continue;
      finding.confused_with.push_back(round.findings[k].effect);
      const Effect& other = *round.candidates[k].effect;
      if (!other.card().per_press && !related(*round.candidates[best].effect, other))
        beside.push_back(&round.findings[k]);
    }
    finding.share_among = share_among(finding, beside);
    d.findings.push_back(finding);
    base = make_baseline(round.candidates[best].fitted.model, g, folds);
    round.findings[best].effect.clear();
    drop_included(base, d);
    drop_superfluous(base, g, folds, options, d);
    take_simpler(base, g, folds, options, d);
    kind = Kind::kNamed;
    ++added;
  }
  for (Finding& f : d.findings)
    std::erase_if(f.confused_with, [&](const std::string& other) {
      return f.verdict == Verdict::kMissing && base.fitted.model.has(other);
    });
  for (const Round& round : last) list_the_rest(round, options.gates, d);
  put_in_order(d.findings);
  for (const Round& round : last) {
    d.findings.insert(d.findings.end(), round.ruled_out.begin(), round.ruled_out.end());
    d.findings.insert(d.findings.end(), round.untestable.begin(), round.untestable.end());
  }
}

// On what is unseen, with all that is missing, or with the best of the rivals.
double unseen_error(const Baseline& base, const Diagnosis& d) {
  double least = base.held_out.error.pooled;
  for (const Finding& f : d.findings)
    if (f.verdict == Verdict::kIndistinguishable) least = std::min(least, f.held_out_after.pooled);
  return least;
}

bool is_any(const EffectCard&) {
  return true;
}
bool is_learned(const EffectCard& card) {
  return card.learned;
}

bool any_missing(const Diagnosis& d, bool (*kind)(const EffectCard&)) {
  return std::any_of(d.findings.begin(), d.findings.end(), [&](const Finding& f) {
    return f.verdict == Verdict::kMissing && kind(require_effect(f.effect).card());
  });
}

bool is_settled(const Finding& f) {
  return f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
}

// How many things a diagnosis takes, rivals for one.
std::size_t count_of(const Diagnosis& d) {
  const auto missing = std::count_if(d.findings.begin(), d.findings.end(), [](const Finding& f) {
    return f.verdict == Verdict::kMissing;
  });
  return static_cast<std::size_t>(missing) + (d.rivals.empty() ? 0 : 1);
}

LeftOver left_of(const Baseline& base, const TrialGround& g, const Diagnosis& d) {
  return d.rivals.empty() ? left_over(base.fitted, g) : d.left;
}

constexpr double kAsLittle = 1.1;  // an unseen error over another that counts as no larger

// A value of each press follows whatever differs from press to press and foretells no other one.
// Where a set without it leaves noise alone, or errs as little on what is unseen, within a tenth
// (there each press is given its value), that is what the data say.
void prefer_without_offsets(const Baseline& first, const Diagnosis& nothing, Baseline& base,
                            const TrialGround& g, const Folds& folds,
                            const DiagnoseOptions& options, Diagnosis& d) {
  const auto offsets = std::find_if(d.findings.begin(), d.findings.end(), [](const Finding& f) {
    return f.verdict == Verdict::kMissing && require_effect(f.effect).card().per_press;
  });
  if (offsets == d.findings.end() || !options.unknown.empty()) return;
  DiagnoseOptions without = options;
  without.unknown = offsets->effect;
  Baseline other_base = first;
  Diagnosis other = nothing;
  search_from(Kind::kNamed, Rivals::kGoOn, other_base, g, folds, without, other);
  if (!other.rivals.empty() || !any_missing(other, is_any)) return;
  if (!left_over(other_base.fitted, g).noise_alone() &&
      unseen_error(other_base, other) > kAsLittle * unseen_error(base, d))
    return;
  other.findings.push_back(*offsets);
  other.findings.back().verdict = Verdict::kPossible;
  other.findings.back().evidence +=
      "; what is named errs as little on what is unseen, within a tenth, without a value of each "
      "press";
  put_in_order(other.findings);
  base = std::move(other_base);
  d = std::move(other);
}

}  // namespace

void put_in_order(std::vector<Finding>& findings) {
  std::stable_sort(findings.begin(), findings.end(), [&](const Finding& a, const Finding& b) {
    if (is_settled(a) || is_settled(b)) return is_settled(a) && !is_settled(b);
    return a.criterion_gain > b.criterion_gain;
  });
}

void curves_for_doubted(Baseline& base, const TrialGround& g, const Folds& folds,
                        const DiagnoseOptions& options, Diagnosis& d) {
  const bool doubted = std::any_of(d.findings.begin(), d.findings.end(),
                                   [](const Finding& f) { return f.doubted && f.curve.empty(); });
  if (!doubted || !d.rivals.empty() || any_missing(d, is_learned) ||
      left_over(base.fitted, g).noise_alone())
    return;
  Baseline learned_base = base;
  Diagnosis learned;
  search_from(Kind::kLearned, Rivals::kEnd, learned_base, g, folds, options, learned);
  if (!learned.rivals.empty() || !any_missing(learned, is_learned) ||
      outweighed(learned_base, g, learned.findings) != nullptr)
    return;
  for (Finding& f : d.findings)
    if (f.curve.empty()) f.doubted = false;  // it need not be added for what it foretells
  for (const Finding& found : learned.findings) {
    if (found.verdict != Verdict::kMissing) continue;
    std::erase_if(d.findings, [&](const Finding& f) { return f.effect == found.effect; });
    d.findings.push_back(found);
  }
  put_in_order(d.findings);
  base = std::move(learned_base);
}

void search(Baseline& base, const TrialGround& g, const Folds& folds,
            const DiagnoseOptions& options, Diagnosis& d) {
  Baseline other_base = base;
  Diagnosis other = d;
  search_from(Kind::kNamed, Rivals::kGoOn, base, g, folds, options, d);
  prefer_without_offsets(other_base, other, base, g, folds, options, d);
  // What the allowance for mesh and shape swallows may be what a wrong name leaves.
  const LeftOver left = left_of(base, g, d);
  const bool explained = left.noise_alone() && left.error < kLikeNoise;
  std::size_t names = 0;
  bool offsets = false;
  for (const Finding& f : d.findings) {
    if (!is_settled(f)) continue;
    ++names;
    offsets = offsets || require_effect(f.effect).card().per_press;
  }
  const bool crowd = d.rivals.empty() && names >= kCrowd;
  if ((explained && !offsets && !crowd) || names == 0 || folds.held_out.empty()) return;
  search_from(Kind::kLearned, Rivals::kGoOn, other_base, g, folds, options, other);
  if (!any_missing(other, is_learned)) return;
  const double now = unseen_error(base, d), then = unseen_error(other_base, other);
  const bool fewer =
      crowd && count_of(other) < names && left_of(other_base, g, other).noise_alone();
  if (then >= kPlainlyLess * now && !(fewer && then <= kAsLittle * now)) return;
  base = std::move(other_base);
  d = std::move(other);
}

}  // namespace hapsim
