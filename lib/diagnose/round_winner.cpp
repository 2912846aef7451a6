#include "diagnose/round_winner.h"

#include "diagnose/round_judge.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

// What is learned from the data has no form that could be wrong, and gives way to an effect with
// one that does about as well where nobody has pressed.
bool learned_beats(const Finding& learned, const Finding& named) {
  return learned.held_out_after.pooled < kPlainlyLess * named.held_out_after.pooled;
}

bool decided(const Finding& winner, const Finding& rival, double allowed) {
  return winner.rmse_after.pooled < kLikeNoise * allowed && winner.memory < kLikeWhite &&
         winner.criterion_gain - rival.criterion_gain > kNoRival * winner.memory;
}

// A kernel of another form is worth a name only where more Maxwell elements do not help: enough of
// them are any kernel.
bool gives_way(std::size_t k, const Round& round, const Gates& gates, bool can_hold_out) {
  if (!refines_relaxation(*round.candidates[k].effect)) return false;
  for (std::size_t j = 0; j < round.findings.size(); ++j)
    if (round.candidates[j].effect == &maxwell_effect() &&
        passes(round.findings[j], gates, can_hold_out))
      return true;
  return false;
}

}  // namespace

bool passes(const Finding& f, const Gates& gates, bool can_hold_out) {
  return !f.within_form && f.criterion_gain > gates.criterion_gain && f.p_value < gates.p_value &&
         f.share >= gates.share && (!can_hold_out || held_out_fall(f) >= gates.held_out_fall);
}

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
    if (gives_way(k, round, gates, can_hold_out)) continue;
    if (round.candidates[k].effect->card().is_field)
      field = k;
    else if (better(k))
      best = k;
  }
  const bool learned =
      field != none && (best == none || learned_beats(round.findings[field], round.findings[best]));
  return learned ? field : best;
}

std::vector<std::size_t> rivals_of(std::size_t best, const Round& round, const Gates& gates,
                                   bool can_hold_out, double allowed) {
  std::vector<std::size_t> rivals;
  const Finding& winner = round.findings[best];
  for (std::size_t k = 0; k < round.findings.size(); ++k) {
    const Finding& f = round.findings[k];
    if (k == best || !passes(f, gates, can_hold_out)) continue;
    const EffectCard& card = round.candidates[k].effect->card();
    if (card.per_press || decided(winner, f, allowed)) continue;
    if (gives_way(k, round, gates, can_hold_out)) continue;
    // Best of what is unseen: best_of() has compared them.
    if (card.is_field || round.candidates[best].effect->card().is_field) continue;
    if (related(*round.candidates[best].effect, *round.candidates[k].effect)) continue;
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

}  // namespace hapsim
