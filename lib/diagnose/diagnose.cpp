#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "diagnose/few_presses.h"
#include "diagnose/foretold.h"
#include "diagnose/held_out.h"
#include "diagnose/rivals_together.h"
#include "diagnose/shared_by_places.h"
#include "diagnose/superfluous.h"
#include "diagnose/try_effects.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

// Without positions or presses to hold out, the other gates decide.
bool passes(const Finding& f, const Gates& gates, bool can_hold_out) {
  return !f.within_form && f.criterion_gain > gates.criterion_gain && f.p_value < gates.p_value &&
         f.share >= gates.share && (!can_hold_out || held_out_fall(f) >= gates.held_out_fall);
}

// What is learned from the data has no form that could be wrong, and gives way to an effect with
// one that does about as well where nobody has pressed.
bool learned_beats(const Finding& learned, const Finding& named) {
  constexpr double kPlainlyLess = 0.9;  // of two errors
  return learned.held_out_after.pooled < kPlainlyLess * named.held_out_after.pooled;
}

// The effect to add: of those that pass the gates the one with the largest gain. Offsets of each
// press imitate any misfit in part, at the price of many parameters, and come after all else.
std::size_t best_of(const Round& round, const Gates& gates, bool can_hold_out) {
  const std::size_t none = round.findings.size();
  std::size_t best = none, field = none;
  const auto better = [&](std::size_t k) {
    if (best == none) return true;
    const EffectCard& card = round.candidates[k].effect->card();
    const EffectCard& best_card = round.candidates[best].effect->card();
    if (card.per_press != best_card.per_press) return best_card.per_press;
    return round.findings[k].criterion_gain > round.findings[best].criterion_gain;
  };
  for (std::size_t k = 0; k < none; ++k) {
    if (!passes(round.findings[k], gates, can_hold_out)) continue;
    if (round.candidates[k].effect->card().is_field)
      field = k;
    else if (better(k))
      best = k;
  }
  const bool learned =
      field != none && (best == none || learned_beats(round.findings[field], round.findings[best]));
  return learned ? field : best;
}

bool decided(const Finding& winner, const Finding& rival, double noise) {
  return winner.rmse_after.pooled < kLikeNoise * noise && winner.memory < kLikeWhite &&
         winner.criterion_gain - rival.criterion_gain > kNoRival * winner.memory;
}

// Rivals that do as well as the best: another effect that passes the gates too and reaches nearly
// the same fall, unless one of the two includes the other.
std::vector<std::size_t> rivals_of(std::size_t best, const Round& round, const Gates& gates,
                                   bool can_hold_out, double noise) {
  std::vector<std::size_t> rivals;
  const Finding& winner = round.findings[best];
  for (std::size_t k = 0; k < round.findings.size(); ++k) {
    const Finding& f = round.findings[k];
    if (k == best || !passes(f, gates, can_hold_out)) continue;
    const EffectCard& card = round.candidates[k].effect->card();
    if (card.per_press || decided(winner, f, noise)) continue;
    // Best of what is unseen: best_of() has compared them.
    if (card.is_field || round.candidates[best].effect->card().is_field) continue;
    if (contains(*round.candidates[best].effect, f.effect) ||
        contains(*round.candidates[k].effect, winner.effect))
      continue;
    // Falls saturate where the model erred much: what is left must be alike too.
    const bool as_good =
        f.rmse_after.pooled <= kAlike * winner.rmse_after.pooled &&
        (can_hold_out ? held_out_fall(f) >= gates.rival_fall * held_out_fall(winner)
                      : f.share >= gates.rival_fall * winner.share);
    if (as_good || winner.criterion_gain - f.criterion_gain < gates.criterion_gain)
      rivals.push_back(k);
  }
  return rivals;
}

// What is settled first, as it was found; then the largest gain.
void put_in_order(std::vector<Finding>& findings) {
  const auto settled = [](const Finding& f) {
    return f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
  };
  std::stable_sort(findings.begin(), findings.end(), [&](const Finding& a, const Finding& b) {
    if (settled(a) || settled(b)) return settled(a) && !settled(b);
    return a.criterion_gain > b.criterion_gain;
  });
}

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
    finding.verdict =
        f.criterion_gain > gates.criterion_gain && !by_chance && f.share >= gates.share
            ? Verdict::kPossible
            : Verdict::kAbsent;
    d.findings.push_back(finding);
  }
}

// Whether the round ended in rivals that the data cannot tell apart; they then stand in `d`.
bool ends_in_rivals(Round& round, std::size_t best, const TrialGround& g, const Gates& gates,
                    bool can_hold_out, Diagnosis& d) {
  std::vector<std::size_t> rivals = rivals_of(best, round, gates, can_hold_out, g.allowance.noise);
  if (std::any_of(rivals.begin(), rivals.end(), [&](std::size_t k) {
        return both_act(round.candidates[best], round.candidates[k], g);
      }))
    return false;  // the next rounds find the other
  if (rivals.empty()) return false;
  rivals.insert(rivals.begin(), best);
  d.left = left_over(round.candidates[best].fitted, g);
  for (const std::size_t k : rivals) {
    d.rivals.push_back(round.candidates[k].fitted.model);
    Finding finding = round.findings[k];
    finding.verdict = Verdict::kIndistinguishable;
    for (const std::size_t other : rivals)
      if (other != k) finding.confused_with.push_back(round.findings[other].effect);
    d.findings.push_back(finding);
  }
  for (Finding& f : round.findings)
    if (std::any_of(rivals.begin(), rivals.end(),
                    [&](std::size_t k) { return round.findings[k].effect == f.effect; }))
      f.effect.clear();
  return true;
}

// Adds the best effect while one passes the gates; where no effect that has a name does, and not
// noise alone is left, the best curve of no law. `kind`: what is tried first.
void search(Kind kind, Baseline& base, const TrialGround& g, const Folds& folds,
            const DiagnoseOptions& options, Diagnosis& d) {
  const bool can_hold_out = !folds.held_out.empty();
  Random random(options.seed);
  std::array<Round, 2> last;  // by Kind
  for (int added = 0; added < options.gates.most_effects;) {
    Round& round = last[static_cast<std::size_t>(kind)];
    round = try_all(kind, base, g, folds, options, random);
    const std::size_t best = best_of(round, options.gates, can_hold_out);
    if (best == round.findings.size()) {
      if (kind == Kind::kLearned || left_over(base.fitted, g).noise_alone()) break;
      kind = Kind::kLearned;
      continue;
    }
    if (ends_in_rivals(round, best, g, options.gates, can_hold_out, d)) break;
    Finding finding = round.findings[best];
    finding.verdict = Verdict::kMissing;
    for (std::size_t k = 0; k < round.findings.size(); ++k)
      if (k != best && passes(round.findings[k], options.gates, can_hold_out))
        finding.confused_with.push_back(round.findings[k].effect);
    d.findings.push_back(finding);
    base = make_baseline(round.candidates[best].fitted.model, g, folds);
    round.findings[best].effect.clear();
    drop_included(base, d);
    drop_superfluous(base, g, folds, options, d);
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

// A name is believed first; where all names together leave more than noise, or one of them is an
// offset of each press, which imitates anything, a curve of no law is tried in their place, and
// stands where it foretells plainly better: the cause is then of its kind, and of none of their
// forms.
void search_both_ways(Baseline& base, const TrialGround& g, const Folds& folds,
                      const DiagnoseOptions& options, Diagnosis& d) {
  constexpr double kPlainlyLess = 0.9;  // of two errors
  Baseline other_base = base;
  Diagnosis other = d;
  search(Kind::kNamed, base, g, folds, options, d);
  const bool explained =
      d.rivals.empty() ? left_over(base.fitted, g).noise_alone() : d.left.noise_alone();
  bool any = false, offsets = false;
  for (const Finding& f : d.findings) {
    if (f.verdict != Verdict::kMissing && f.verdict != Verdict::kIndistinguishable) continue;
    any = true;
    offsets = offsets || require_effect(f.effect).card().per_press;
  }
  if ((explained && !offsets) || !any || folds.held_out.empty()) return;
  search(Kind::kLearned, other_base, g, folds, options, other);
  const bool learned =
      std::any_of(other.findings.begin(), other.findings.end(), [](const Finding& f) {
        return f.verdict == Verdict::kMissing && require_effect(f.effect).card().learned;
      });
  if (!learned || unseen_error(other_base, other) >= kPlainlyLess * unseen_error(base, d)) return;
  base = std::move(other_base);
  d = std::move(other);
}

void search_few(Baseline& base, const TrialGround& g, const DiagnoseOptions& options,
                Diagnosis& d) {
  const FewPresses few = diagnose_few_presses(base, g, options);
  d.findings = few.findings;
  put_in_order(d.findings);
  d.findings.insert(d.findings.end(), few.untestable.begin(), few.untestable.end());
  d.rivals = few.rivals;
  base = make_baseline(few.end.model, g, {});
  d.held_out = few.held_out;
  d.held_out_end = few.held_out_end;
  d.held_out_by = unseen_by(g.dataset, options.folds);
}

}  // namespace

std::string verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissing:
      return "missing";
    case Verdict::kPossible:
      return "possible";
    case Verdict::kIndistinguishable:
      return "indistinguishable";
    case Verdict::kAbsent:
      return "absent";
    default:
      return "not testable";
  }
}

std::string verdict_name(ModelVerdict verdict) {
  switch (verdict) {
    case ModelVerdict::kComplete:
      return "complete";
    case ModelVerdict::kIncomplete:
      return "incomplete";
    case ModelVerdict::kAmbiguous:
      return "ambiguous";
    default:
      return "unexplained";
  }
}

namespace {

Diagnosis with_allowance(const Model& model, const TrialGround& g, const DiagnoseOptions& options) {
  const bool few_presses = g.dataset.episodes.size() < kLeastPresses;
  const Folds folds = few_presses ? Folds{} : make_folds(g.dataset, options.folds);
  Baseline base = make_baseline(model, g, folds);
  if (!base.fitted.converged)
    fail_numerics(g.dataset.recording.name, "the model does not fit: " + base.fitted.message,
                  "identify it again with hs-identify");
  Diagnosis d;
  d.noise = g.allowance.noise;
  d.noise_measured = g.experiment.noise.measured;
  d.floor = g.allowance.floor;
  d.shape = g.experiment.shape;
  d.mesh_uncertainty = g.experiment.places.mesh_uncertainty();
  d.rmse = base.fitted.error;
  d.kind_now = left_over(base.fitted, g).kind;
  d.held_out = base.held_out.error;
  d.held_out_by = folds.by;
  const Eigen::VectorXd measured = measured_forces(g.dataset, all_episodes(g.dataset));
  d.force_rms = force_error(g.dataset, measured);

  if (few_presses)
    search_few(base, g, options, d);
  else
    search_both_ways(base, g, folds, options, d);
  const bool ambiguous = !d.rivals.empty();
  if (!few_presses && !ambiguous &&
      doubt_what_places_share(base, g, folds, options.gates, d.findings))
    put_in_order(d.findings);
  if (d.rivals.empty()) d.rivals.push_back(base.fitted.model);
  d.rmse_end = base.fitted.error;
  if (!few_presses) d.held_out_end = base.held_out.error;
  if (few_presses || !ambiguous) d.left = left_over(base.fitted, g);
  const bool missing =
      std::any_of(d.findings.begin(), d.findings.end(),
                  [](const Finding& finding) { return finding.verdict == Verdict::kMissing; });
  d.verdict = ambiguous               ? ModelVerdict::kAmbiguous
              : missing               ? ModelVerdict::kIncomplete
              : !d.left.noise_alone() ? ModelVerdict::kUnexplained
                                      : ModelVerdict::kComplete;
  d.explanation = describe_verdict(d);
  if (!few_presses) return d;
  const std::size_t presses = g.dataset.episodes.size();
  const std::string count = presses == 1 ? "one press" : fmt::format("{} presses", presses);
  if (d.verdict == ModelVerdict::kUnexplained)
    d.explanation = fmt::format(
        "the model fails by {:.2g} x noise, but {} cannot name the cause with a false-alarm rate; "
        "the possible effects stand below, the best first. Record {} presses or more.",
        d.rmse_end.told() / d.noise, count, kLeastPresses);
  else
    d.explanation += fmt::format(
        " Judged by the time within {} alone, which says nothing of other places; record {} "
        "presses "
        "or more.",
        count, kLeastPresses);
  return d;
}

bool moves_body(const Model& model) {
  const std::vector<std::string> effects = model.effects();
  return std::any_of(effects.begin(), effects.end(), [](const std::string& name) {
    return require_effect(name).card().moves_body;
  });
}

bool names(const Diagnosis& d, bool (*kind)(const EffectCard&)) {
  return std::any_of(d.findings.begin(), d.findings.end(), [&](const Finding& f) {
    return (f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable) &&
           kind(require_effect(f.effect).card());
  });
}

// Stiffnesses that differ by place beyond what is allowed are no work of the shape.
bool differs_by_place(const Model& model, const TrialGround& g) {
  const Fit fitted = fit(model, g.experiment, all_episodes(g.dataset), trial_fit_options(g));
  return left_over(fitted, g).kind == kBody;
}

}  // namespace

Diagnosis diagnose(const Model& model, const Experiment& e, const Allowance& allowance,
                   const DiagnoseOptions& options) {
  Diagnosis d = with_allowance(model, {e, allowance}, options);
  // Points off the surface that no move explains, of the kind that forces follow, are a wrong
  // shape: what differs by place may be its work.
  if (d.verdict == ModelVerdict::kComplete || !e.shape.plain() ||
      e.doubted_floor <= allowance.floor || moves_body(model) ||
      names(d, [](const EffectCard& card) { return card.moves_body; }))
    return d;
  options.tell("the shape in doubt");
  const TrialGround doubted_ground(e, {allowance.noise, e.doubted_floor});
  if (!names(d, [](const EffectCard& card) { return card.like_shape && !card.is_field; }) &&
      differs_by_place(model, doubted_ground))
    return d;
  d = with_allowance(model, doubted_ground, options);
  d.shape_in_doubt = true;
  std::string doubted;
  for (Finding& f : d.findings) {
    if (f.verdict != Verdict::kMissing || !require_effect(f.effect).card().like_shape) continue;
    f.verdict = Verdict::kIndistinguishable;
    f.confused_with.push_back("shape");
    doubted += (doubted.empty() ? "" : ", ") + f.effect;
  }
  if (doubted.empty()) return d;
  d.verdict = ModelVerdict::kAmbiguous;
  d.explanation = fmt::format(
      "the data cannot tell {} from a wrong shape of the body: scan it again, or touch it where it "
      "is pressed.",
      doubted);
  return d;
}

}  // namespace hapsim
