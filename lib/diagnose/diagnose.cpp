#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnose/candidate.h"
#include "diagnose/departures.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

bool contains(const Effect& effect, const std::string& other) {
  const auto& list = effect.card().contains;
  return std::find(list.begin(), list.end(), other) != list.end();
}

// Effects worth trying on top of a model: those it lacks, and one more term of those with terms.
std::vector<const Effect*> untried(const Model& model) {
  std::vector<const Effect*> effects;
  for (const Effect* effect : catalogue()) {
    const EffectCard& card = effect->card();
    if (card.name == "elastic") continue;
    if (model.has(card.name) && (!card.terms || card.from_locations)) continue;
    const bool included =
        std::any_of(catalogue().begin(), catalogue().end(), [&](const Effect* other) {
          return model.has(other->card().name) && contains(*other, card.name);
        });
    if (!included) effects.push_back(effect);
  }
  return effects;
}

struct Round {
  std::vector<Candidate> candidates;
  std::vector<Finding> findings;   // one a candidate, same order
  std::vector<Finding> ruled_out;  // without a fit
  std::vector<Finding> untestable;
};

double held_out_fall(const Finding& f) {
  return f.held_out_now > 0 ? 1 - f.held_out_after / f.held_out_now : 0;
}

// From here on an effect's size may speak for it: of the squared misfit, and of the error on unseen
// positions.
constexpr double kMostOfIt = 0.5, kPlainFall = 0.1;

// With fewer presses their signs have too few arrangements to tell chance from cause.
constexpr std::size_t kLeastPresses = 6;

// Without positions or presses to hold out, the other gates decide.
bool passes(const Finding& f, const Gates& gates, bool can_hold_out) {
  return !f.within_form && f.criterion_gain > gates.criterion_gain && f.p_value < gates.p_value &&
         f.share >= gates.share && (!can_hold_out || held_out_fall(f) >= gates.held_out_fall);
}

// Family-wise chances of a false alarm: by sign flips, and where an effect has a test of its own by
// that, times the number of effects tried (Bonferroni).
std::vector<double> p_values(const std::vector<Measured>& measured, int flips, Random& random) {
  std::vector<CandidateScores> scores;
  for (const Measured& m : measured)
    if (m.scores.by_group.size() > 0) scores.push_back(m.scores);
  const std::vector<double> flipped = sign_flip_p_values(scores, flips, random);
  std::vector<double> p;
  std::size_t next = 0;
  for (const Measured& m : measured)
    p.push_back(m.scores.by_group.size() > 0
                    ? flipped[next++]
                    : std::min(1.0, m.p_value * static_cast<double>(measured.size())));
  return p;
}

double force_change(const Model& a, const Model& b, const Workspace& w) {
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd d = model_forces(a, w.dataset, all, *w.body, false).f -
                            model_forces(b, w.dataset, all, *w.body, false).f;
  return std::sqrt(d.squaredNorm() / static_cast<double>(d.size()));
}

// What the model's approximate laws may leave [N]: from less, no other effect can be inferred.
double left_by_laws(const Model& model, const Workspace& w) {
  double most = 0;
  for (const std::string& name : model.effects()) {
    const double share = require_effect(name).card().form_error;
    if (share <= 0) continue;
    Model without = model;
    std::erase_if(without.parameters, [&](const Parameter& p) { return p.effect == name; });
    most = std::max(most, share * force_change(model, without, w));
  }
  return most;
}

// Worth refining: candidates whose first fit errs by less than this factor over the best one's, and
// by less than the baseline.
constexpr double kPromising = 2.5, kBetter = 0.99;

// The best estimates first: what they become decides what else is worth the solutions.
void refine_promising(std::vector<Candidate>& candidates, const Baseline& base, Workspace& w) {
  std::vector<Candidate*> order;
  double least = base.fitted.rmse;
  for (Candidate& c : candidates) {
    order.push_back(&c);
    least = std::min(least, c.fitted.rmse);
  }
  std::stable_sort(order.begin(), order.end(), [](const Candidate* a, const Candidate* b) {
    return a->fitted.rmse < b->fitted.rmse;
  });
  for (Candidate* c : order) {
    if (c->fitted.rmse >= kPromising * least || c->fitted.rmse >= kBetter * base.fitted.rmse)
      continue;
    refine(*c, w);
    least = std::min(least, c->fitted.rmse);
  }
}

Round try_all(const Baseline& base, Workspace& w, const Folds& folds,
              const DiagnoseOptions& options, Random& random) {
  Round round;
  const bool departs = stiffness_departures(base.fitted.model, w).anywhere();
  for (const Effect* effect : untried(base.fitted.model)) {
    if (options.progress) options.progress(effect->card().name);
    if (effect->card().solved && !departs && lacking_for(effect->card(), w.dataset).empty()) {
      Finding finding;
      finding.effect = effect->card().name;
      finding.rmse_now = finding.rmse_after = base.fitted.rmse;
      finding.held_out_now = finding.held_out_after = base.held_out.rmse;
      finding.evidence =
          "no position asks for another stiffness than the model's, beyond noise and mesh";
      finding.next_measurement = effect->card().separated_by;
      round.ruled_out.push_back(finding);
      continue;
    }
    std::string lack;
    if (auto candidate = try_effect(*effect, base, w, lack)) {
      round.candidates.push_back(std::move(*candidate));
      continue;
    }
    Finding finding;
    finding.effect = effect->card().name;
    finding.verdict = Verdict::kNotTestable;
    finding.evidence = lack;
    finding.next_measurement = lack;
    round.untestable.push_back(finding);
  }
  refine_promising(round.candidates, base, w);
  const Yardstick yardstick = make_yardstick(base, round.candidates, w);
  std::vector<Measured> measured;
  for (const Candidate& c : round.candidates) measured.push_back(measure(c, base, yardstick, w));
  const std::vector<double> p = p_values(measured, options.flips, random);
  const double before = yardstick.residual.squaredNorm();
  const double noise = w.noise.value * w.noise.value;
  const double by_laws = left_by_laws(base.fitted.model, w);
  const double beyond_noise = base.fitted.rmse * base.fitted.rmse - noise;
  for (std::size_t k = 0; k < round.candidates.size(); ++k) {
    Candidate& c = round.candidates[k];
    const Measured& m = measured[k];
    Finding f;
    f.effect = c.effect->card().name;
    f.one_more_term = c.one_more_term;
    f.rmse_now = base.fitted.rmse;
    f.rmse_after = c.fitted.rmse;
    f.held_out_now = base.held_out.rmse;
    f.held_out_after = std::nan("");
    f.evidence = implausible(c.fitted.model, *c.effect, w.dataset);
    if (!f.evidence.empty()) {
      round.findings.push_back(f);
      continue;
    }
    f.p_value = p[k];
    f.criterion_gain = before - m.sum_of_squares - m.penalty;
    f.memory = m.memory;
    const double fall = base.fitted.rmse * base.fitted.rmse - c.fitted.rmse * c.fitted.rmse;
    if (beyond_noise > 0.01 * noise)
      f.share = std::clamp((std::isnan(m.explained) ? fall : m.explained) / beyond_noise, 0.0, 1.0);
    // Refits for held-out positions cost most and only matter to what passes otherwise.
    if (f.criterion_gain > options.gates.criterion_gain && f.share >= options.gates.share)
      hold_out(c, w, folds);
    f.held_out_after = c.held_out.rmse;
    // Where few presses carry an effect their signs cannot prove it, however large it is.
    const double by_size =
        std::min(1.0, 2 * m.p_by_size * static_cast<double>(round.candidates.size()));
    if (f.share >= kMostOfIt && held_out_fall(f) >= kPlainFall)
      f.p_value = std::min(f.p_value, by_size);
    f.plain = f.share >= kMostOfIt && by_size < options.gates.p_value;
    f.within_form = by_laws > 0 && force_change(c.fitted.model, base.fitted.model, w) < by_laws;
    f.where = describe_where(c, w);
    f.evidence = describe_evidence(c, m, f);
    if (f.within_form)
      f.evidence += fmt::format(
          "; changes the forces by less than the {:.2g} N that an approximate law in the model may "
          "leave",
          by_laws);
    f.next_measurement = c.effect->card().separated_by;
    round.findings.push_back(f);
  }
  return round;
}

// The effect to add: of those that pass the gates the one with the largest gain. Offsets of each
// press imitate any misfit in part, at the price of many parameters, and come after all else.
std::size_t best_of(const Round& round, const Gates& gates, bool can_hold_out) {
  std::size_t best = round.findings.size();
  const auto better = [&](std::size_t k) {
    if (best == round.findings.size()) return true;
    const bool late = round.candidates[k].effect->card().by_press;
    const bool best_late = round.candidates[best].effect->card().by_press;
    if (late != best_late) return best_late;
    return round.findings[k].criterion_gain > round.findings[best].criterion_gain;
  };
  for (std::size_t k = 0; k < round.findings.size(); ++k)
    if (passes(round.findings[k], gates, can_hold_out) && better(k)) best = k;
  return best;
}

constexpr double kAlike = 1.25;  // errors that differ by less

// Where the winner leaves white noise and nothing else, the likelihood can be believed: a rival
// that is so much less likely (of the criterion, by independent sample) is none, however alike the
// errors.
constexpr double kDecisive = 50, kLikeNoise = 1.1, kLikeWhite = 1.5;

bool decided(const Finding& winner, const Finding& rival, double noise) {
  return winner.rmse_after < kLikeNoise * noise && winner.memory < kLikeWhite &&
         winner.criterion_gain - rival.criterion_gain > kDecisive * winner.memory;
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
    if (round.candidates[k].effect->card().by_press || decided(winner, f, noise)) continue;
    if (contains(*round.candidates[best].effect, f.effect) ||
        contains(*round.candidates[k].effect, winner.effect))
      continue;
    // Falls saturate where the model erred much: what is left must be alike too.
    const bool as_good =
        f.rmse_after <= kAlike * winner.rmse_after &&
        (can_hold_out ? held_out_fall(f) >= gates.rival_fall * held_out_fall(winner)
                      : f.share >= gates.rival_fall * winner.share);
    if (as_good || winner.criterion_gain - f.criterion_gain < gates.criterion_gain)
      rivals.push_back(k);
  }
  return rivals;
}

// A structure that noise does not have: neighbouring whitened residuals that go together.
double neighbour_correlation(const Eigen::VectorXd& residual, const Workspace& w) {
  double product = 0, square = 0;
  Eigen::Index at = 0;
  for (const Episode& e : w.dataset.episodes) {
    for (std::size_t i = 0; i < e.rows.size(); ++i, ++at) {
      square += residual.segment<3>(3 * at).squaredNorm();
      if (i > 0) product += residual.segment<3>(3 * at).dot(residual.segment<3>(3 * at - 3));
    }
  }
  return square > 0 ? product / square : 0;
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

Diagnosis diagnose(const Model& model, Workspace& w, const DiagnoseOptions& options) {
  Random random(options.seed);
  const Folds folds = make_folds(w.dataset, options.folds);
  const bool can_hold_out = !folds.held_out.empty();
  Baseline base = make_baseline(model, w, folds);
  if (!base.fitted.converged)
    fail_numerics(w.dataset.recording.name, "the model does not fit: " + base.fitted.message,
                  "identify it again with hs-identify");
  Diagnosis d;
  d.noise = w.noise.value;
  d.noise_measured = w.noise.measured;
  d.floor = w.floor;
  d.mesh_uncertainty = w.body->mesh_uncertainty();
  d.rmse = base.fitted.rmse;
  d.held_out = base.held_out.rmse;
  d.held_out_by = folds.by;
  const Eigen::VectorXd measured = measured_forces(w.dataset, all_episodes(w.dataset));
  d.force_rms = std::sqrt(measured.squaredNorm() / static_cast<double>(measured.size()));

  const bool few_presses = w.dataset.episodes.size() < kLeastPresses;
  Round last;
  bool ambiguous = false;
  for (int step = 0; step < options.gates.most_effects; ++step) {
    Round round = try_all(base, w, folds, options, random);
    const std::size_t best = best_of(round, options.gates, can_hold_out);
    last = std::move(round);
    if (best == last.findings.size()) break;
    std::vector<std::size_t> rivals =
        rivals_of(best, last, options.gates, can_hold_out, w.noise.value);
    if (!rivals.empty()) {
      ambiguous = true;
      rivals.insert(rivals.begin(), best);
      for (const std::size_t k : rivals) {
        d.rivals.push_back(last.candidates[k].fitted.model);
        Finding finding = last.findings[k];
        finding.verdict = Verdict::kIndistinguishable;
        for (const std::size_t other : rivals)
          if (other != k) finding.confused_with.push_back(last.findings[other].effect);
        d.findings.push_back(finding);
      }
      for (Finding& f : last.findings)
        if (std::any_of(rivals.begin(), rivals.end(),
                        [&](std::size_t k) { return last.findings[k].effect == f.effect; }))
          f.effect.clear();
      break;
    }
    Finding finding = last.findings[best];
    finding.verdict = Verdict::kMissing;
    for (std::size_t k = 0; k < last.findings.size(); ++k)
      if (k != best && passes(last.findings[k], options.gates, can_hold_out))
        finding.confused_with.push_back(last.findings[k].effect);
    d.findings.push_back(finding);
    base = make_baseline(last.candidates[best].fitted.model, w, folds);
    last.findings[best].effect.clear();
  }
  for (const Finding& f : last.findings) {
    if (f.effect.empty()) continue;
    const bool known = std::any_of(d.findings.begin(), d.findings.end(),
                                   [&](const Finding& g) { return g.effect == f.effect; });
    if (known) continue;
    Finding finding = f;
    const bool by_chance = !few_presses && !f.plain && f.p_value >= options.gates.p_value;
    finding.verdict = f.criterion_gain > options.gates.criterion_gain && !by_chance &&
                              f.share >= options.gates.share
                          ? Verdict::kPossible
                          : Verdict::kAbsent;
    d.findings.push_back(finding);
  }
  const auto settled = [](const Finding& f) {
    return f.verdict == Verdict::kMissing || f.verdict == Verdict::kIndistinguishable;
  };
  std::stable_sort(d.findings.begin(), d.findings.end(), [&](const Finding& a, const Finding& b) {
    if (settled(a) || settled(b)) return settled(a) && !settled(b);
    return a.criterion_gain > b.criterion_gain;
  });
  d.findings.insert(d.findings.end(), last.ruled_out.begin(), last.ruled_out.end());
  d.findings.insert(d.findings.end(), last.untestable.begin(), last.untestable.end());

  if (d.rivals.empty()) d.rivals.push_back(base.fitted.model);
  d.rmse_end = base.fitted.rmse;
  d.held_out_end = base.held_out.rmse;
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = model_forces(base.fitted.model, w.dataset, all, *w.body, false).f;
  Eigen::VectorXd left = measured - f;
  Weights(w.dataset, all, f, w.noise.value, w.floor).whiten(left);
  d.reduced_chi_square_end = left.squaredNorm() / static_cast<double>(left.size());
  const double correlation = neighbour_correlation(left, w);
  const bool structure = d.reduced_chi_square_end > 1.5 && correlation > 0.2;
  const Departures departures = stiffness_departures(base.fitted.model, w);
  const bool local = departures.at_one();
  const bool missing =
      std::any_of(d.findings.begin(), d.findings.end(),
                  [](const Finding& finding) { return finding.verdict == Verdict::kMissing; });
  d.verdict = ambiguous            ? ModelVerdict::kAmbiguous
              : missing            ? ModelVerdict::kIncomplete
              : structure || local ? ModelVerdict::kUnexplained
                                   : ModelVerdict::kComplete;
  d.explanation = describe_verdict(d, structure && !ambiguous);
  if (local && d.verdict == ModelVerdict::kUnexplained && !structure)
    d.explanation = fmt::format(
        "the position ({:.1f}, {:.1f}, {:.1f}) mm has a stiffness of its own that no other "
        "position confirms: press around it, a few millimetres apart.",
        1e3 * departures.where.x(), 1e3 * departures.where.y(), 1e3 * departures.where.z());
  if (few_presses && d.verdict == ModelVerdict::kUnexplained)
    d.explanation = fmt::format(
        "the model fails by {:.2g} x noise, but {} presses are too few to name the cause with a "
        "false-alarm rate; the possible effects stand below, the best first. Record {} or more.",
        d.rmse_end / d.noise, w.dataset.episodes.size(), kLeastPresses);
  return d;
}

}  // namespace hapsim
