#include "diagnose/try_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <thread>

#include "base/error.h"
#include "base/parallel.h"
#include "diagnose/departures.h"
#include "diagnose/held_out.h"
#include "diagnose/measure.h"
#include "diagnose/round_judge.h"
#include "diagnose/screens.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "fit/testable.h"

namespace hapsim {
namespace {

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

// Worth refining: candidates whose first fit errs by less than this factor over the best one's, and
// by less than the baseline.
constexpr double kPromising = 2.5, kBetter = 0.99;

// The best estimates first: what they become, not what they promised, decides what else is worth
// the solutions.
void refine_promising(std::vector<Candidate>& candidates, const Baseline& base,
                      const TrialGround& g, const DiagnoseOptions& options) {
  std::vector<Candidate*> order;
  double least = base.fitted.error.pooled;
  for (Candidate& c : candidates) {
    const EffectCard& card = c.effect->card();
    if (!c.starts.empty() || card.is_map) order.push_back(&c);
    // Offsets of presses imitate any misfit and are no measure of it.
    else if (!card.per_press)
      least = std::min(least, c.fitted.error.pooled);
  }
  std::stable_sort(order.begin(), order.end(), [](const Candidate* a, const Candidate* b) {
    return a->fitted.error.pooled < b->fitted.error.pooled;
  });
  for (Candidate* c : order) {
    if (c->fitted.error.pooled >= kPromising * least ||
        c->fitted.error.pooled >= kBetter * base.fitted.error.pooled)
      continue;
    options.tell("refining " + c->effect->card().name);
    refine(*c, g);
    least = std::min(least, c->fitted.error.pooled);
  }
}

}  // namespace

bool refines_relaxation(const Effect& effect) {
  return !effect.card().learned && contains(effect, maxwell_effect().card().name);
}

std::vector<const Effect*> untried(const Model& model, Kind kind, const std::string& unknown) {
  std::vector<const Effect*> effects;
  for (const Effect* effect : catalogue()) {
    const EffectCard& card = effect->card();
    if (effect == &body_effect() || card.name == unknown) continue;
    if (card.learned != (kind == Kind::kLearned)) continue;
    if (model.has(card.name) && (!card.terms || card.is_map)) continue;
    if (refines_relaxation(*effect) && !model.has(maxwell_effect().card().name)) continue;
    const bool included =
        std::any_of(catalogue().begin(), catalogue().end(), [&](const Effect* other) {
          return model.has(other->card().name) && contains(*other, card.name);
        });
    if (!included) effects.push_back(effect);
  }
  return effects;
}

bool contains(const Effect& effect, const std::string& other) {
  const auto& list = effect.card().contains;
  return std::find(list.begin(), list.end(), other) != list.end();
}

bool related(const Effect& a, const Effect& b) {
  return contains(a, b.card().name) || contains(b, a.card().name);
}

namespace {

Finding not_testable(const Effect& effect, const std::string& lack) {
  Finding finding;
  finding.effect = effect.card().name;
  finding.verdict = Verdict::kNotTestable;
  finding.evidence = lack;
  finding.next_measurement = lack;
  return finding;
}

using Counted = std::function<void(const Effect&)>;  // tells of the next effect that is tested

// Tells on the thread that this is called on, and on no other: what is told may speak to a terminal
// or to an interpreter.
std::function<void(const std::string&, std::size_t, std::size_t)> telling_here(
    const DiagnoseOptions& options) {
  return [&options, own = std::this_thread::get_id()](const std::string& what, std::size_t k,
                                                      std::size_t n) {
    if (std::this_thread::get_id() == own) options.tell(what, k, n);
  };
}

// What is known of an effect before finite elements are solved for it.
struct Estimate {
  bool worth = true;
  std::optional<Candidate> candidate;
  std::string lack;  // why there is none
};

// Several at once: each depends on the baseline alone.
std::vector<Estimate> estimate_all(const std::vector<const Effect*>& effects, const Baseline& base,
                                   const TrialGround& g, const Counted& count) {
  std::vector<Estimate> estimates(effects.size());
  in_parallel(effects.size(), g.experiment.places.threads(), [&](std::size_t k) {
    count(*effects[k]);
    Estimate& e = estimates[k];
    e.worth = worth_a_fit(*effects[k], base, g);
    if (e.worth) e.candidate = try_effect(*effects[k], base, g, e.lack);
  });
  return estimates;
}

// Tries effects at some places, and at all of them those that could be rivals of what leaves the
// `least` error, the best first: solved for once, at the values that the screen gave.
void try_at_some_first(const std::vector<const Effect*>& effects, const Departures& departures,
                       double least, const Baseline& base, const TrialGround& g,
                       const DiagnoseOptions& options, const Counted& count, Round& round) {
  const double now = base.fitted.error.pooled;
  Screens screens(base, g, departures);
  std::vector<std::pair<const Effect*, Screens::Tried>> all_tried;
  for (const Effect* effect : effects) {
    count(*effect);
    std::string lack;
    if (auto tried = screens.try_effect(*effect, std::min(kBetter, kPromising * least / now), lack))
      all_tried.emplace_back(effect, std::move(*tried));
    else
      round.untestable.push_back(not_testable(*effect, lack));
  }
  std::stable_sort(all_tried.begin(), all_tried.end(),
                   [](const auto& a, const auto& b) { return a.second.left < b.second.left; });
  for (const auto& [effect, tried] : all_tried) {
    if (tried.left > kBetter || tried.left * now > kAlike * least) {
      round.ruled_out.push_back(ruled_out(*effect, base));
      round.ruled_out.back().evidence =
          fmt::format("on {} of the {} places it leaves {:.0f} % of the error", tried.places,
                      g.dataset.positions.size(), 100 * tried.left_there);
      continue;
    }
    options.tell("solving " + effect->card().name);
    Candidate candidate;
    candidate.effect = effect;
    candidate.one_more_term = base.fitted.model.has(effect->card().name);
    try {
      candidate.fitted =
          fit(tried.model, g.experiment, all_episodes(g.dataset), trial_fit_options(g, 0),
              g.experiment.places.solve(material_of(tried.model)));
    } catch (const Error& error) {  // at a place that the screen did not have
      if (error.code() != ExitCode::kNoConvergence) throw;
      round.untestable.push_back(
          not_testable(*effect, std::string("it cannot be fitted at all places: ") + error.what()));
      continue;
    }
    least = std::min(least, candidate.fitted.error.pooled);
    round.candidates.push_back(std::move(candidate));
  }
}

}  // namespace

Finding ruled_out(const Effect& effect, const Baseline& base) {
  Finding finding;
  finding.effect = effect.card().name;
  finding.rmse_now = finding.rmse_after = base.fitted.error;
  finding.held_out_now = finding.held_out_after = held_out_for(effect, base).error;
  finding.evidence =
      "no position asks for another stiffness than the model's, beyond noise and mesh";
  finding.next_measurement = effect.card().separated_by;
  return finding;
}

Round try_all(Kind kind, const Baseline& base, const TrialGround& g, const Folds& folds,
              const DiagnoseOptions& options, Random& random) {
  Round round;
  const Departures departures = stiffness_departures(base.fitted, g);
  const bool departs = departures.anywhere();
  double least = base.fitted.error.pooled;
  std::vector<const Effect*> at_some_first;
  const std::vector<const Effect*> effects = untried(base.fitted.model, kind, options.unknown);
  std::atomic<std::size_t> tested{0};
  const auto tell = telling_here(options);
  const Counted count = [&](const Effect& effect) {
    tell("testing " + effect.card().name, ++tested, effects.size());
  };
  std::vector<const Effect*> estimated;
  enum class Way { kRuledOut, kAtSomeFirst, kEstimated };
  const auto way_of = [&](const Effect& effect) {
    if (!effect.card().solved || !lacking_for(effect.card(), g.dataset).empty())
      return Way::kEstimated;
    if (!departs) return Way::kRuledOut;
    return has_many_places(g.dataset) ? Way::kAtSomeFirst : Way::kEstimated;
  };
  for (const Effect* effect : effects) {
    const Way way = way_of(*effect);
    if (way == Way::kRuledOut) ++tested;
    if (way == Way::kEstimated) estimated.push_back(effect);
  }
  std::vector<Estimate> estimates = estimate_all(estimated, base, g, count);
  auto estimate = estimates.begin();
  for (const Effect* effect : effects) {
    const Way way = way_of(*effect);
    if (way == Way::kRuledOut) round.ruled_out.push_back(ruled_out(*effect, base));
    if (way == Way::kAtSomeFirst) at_some_first.push_back(effect);
    if (way != Way::kEstimated) continue;
    Estimate& e = *estimate++;
    if (!e.worth) {
      round.ruled_out.push_back(ruled_out(*effect, base));
      round.ruled_out.back().evidence = kTakesNothing;
      continue;
    }
    if (!e.candidate) {
      round.untestable.push_back(not_testable(*effect, e.lack));
      continue;
    }
    if (!effect->card().per_press) least = std::min(least, e.candidate->fitted.error.pooled);
    round.candidates.push_back(std::move(*e.candidate));
  }
  try_at_some_first(at_some_first, departures, least, base, g, options, count, round);
  refine_promising(round.candidates, base, g, options);
  for (Candidate& c : round.candidates)
    if (c.effect->card().is_field) hold_out(c, g, folds);
  const Yardstick yardstick = make_yardstick(base, round.candidates, g);
  std::vector<Measured> measured(round.candidates.size());
  const int threads = g.experiment.places.threads();
  in_parallel(measured.size(), threads, [&](std::size_t k) {
    measured[k] = measure(round.candidates[k], base, yardstick, g);
  });
  const std::vector<double> p = p_values(measured, options.flips, random);
  const RoundJudge judge(base, g, folds, options, round.candidates.size(), tell);
  round.findings.resize(round.candidates.size());
  in_parallel(round.candidates.size(), threads, [&](std::size_t k) {
    round.findings[k] = judge.find(round.candidates[k], measured[k], p[k]);
  });
  return round;
}

}  // namespace hapsim
