#include "diagnose/few_presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnose/departures.h"
#include "diagnose/round.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr std::size_t kBeam = 3;       // sets that are grown on
constexpr double kCrookedest = 0.05;   // force sensor, of its range; the worst on sale are at 0.01
constexpr double kFalseAlarms = 0.01;  // chance of any, where nothing is missing

using Names = std::vector<std::string>;  // sorted; a name twice is a term more

struct Set {
  Names added;
  FitResult fitted;
  Eigen::VectorXd residual;  // [N]
  std::size_t parameters = 0;
};

Names with(Names names, const std::string& name) {
  names.insert(std::upper_bound(names.begin(), names.end(), name), name);
  return names;
}
Names without(Names names, const std::string& name) {
  names.erase(std::find(names.begin(), names.end(), name));
  return names;
}

// Told by comparing presses.
bool needs_many(const EffectCard& card) {
  return card.by_press || card.from_locations;
}

// Sets of effects on top of a model, each fitted once.
class Sets {
 public:
  Sets(const Baseline& base, Workspace& w, const DiagnoseOptions& options)
      : w_(w), options_(options), departs_(stiffness_departures(base.fitted.model, w).anywhere()) {
    keep({}, base.fitted);
  }

  // Nothing when the effect cannot be seen there or comes out implausible.
  const Set* grown(const Set& from, const Effect& effect) {
    const Names names = with(from.added, effect.card().name);
    if (const auto known = all_.find(names); known != all_.end()) return &known->second;
    if (refused_.count(names) > 0) return nullptr;
    if (options_.progress) options_.progress(effect.card().name);
    std::string lack;
    auto candidate = try_effect(effect, {from.fitted, {}}, w_, lack);
    if (candidate) {
      refine(*candidate, w_);
      lack = implausible(candidate->fitted.model, effect, w_.dataset);
      if (lack.empty()) lack = unlike_a_sensor(candidate->fitted.model, effect);
      if (lack.empty()) return keep(names, candidate->fitted);
    } else if (from.added.empty()) {
      lack_[effect.card().name] = lack;
    }
    refused_[names] = lack;
    return nullptr;
  }
  // Why the set is not grown by it.
  std::string refusal(const Set& from, const Effect& effect) const {
    return refused_.at(with(from.added, effect.card().name));
  }

  // The set of these names, grown one by one in any order; nothing when none of them leads there.
  const Set* find(const Names& names) {
    if (const auto known = all_.find(names); known != all_.end()) return &known->second;
    if (refused_.count(names) > 0) return nullptr;
    for (const std::string& name : names)
      if (const Set* smaller = find(without(names, name)))
        if (const Set* set = grown(*smaller, require_effect(name))) return set;
    refused_.emplace(names, "");
    return nullptr;
  }
  // That set, or the largest below it that there is.
  const Set* find_below(Names names) {
    for (; !names.empty(); names.pop_back())
      if (const Set* set = find(names)) return set;
    return find({});
  }

  // What could be added to a set here.
  std::vector<const Effect*> growth(const Set& from) {
    std::vector<const Effect*> effects = untried(from.fitted.model);
    std::erase_if(effects, [&](const Effect* e) {
      const EffectCard& card = e->card();
      return needs_many(card) || (card.solved && !departs_) || lack_.count(card.name) > 0;
    });
    return effects;
  }

  // The set's chi-square plus log n a parameter; what the best one leaves is the unit.
  double criterion(const Set& set) const {
    Eigen::VectorXd r = set.residual;
    Weights(w_.dataset, all_episodes(w_.dataset),
            measured_forces(w_.dataset, all_episodes(w_.dataset)),
            std::max(w_.noise.value, least_->fitted.rmse), w_.floor)
        .whiten(r);
    return r.squaredNorm() / memory_ +
           static_cast<double>(set.parameters) * std::log(std::max(independent_, 2.0));
  }
  const std::map<std::string, std::string>& lack() const { return lack_; }
  bool departs() const { return departs_; }       // some position asks for another stiffness
  std::size_t tried() const { return singles_; }  // effects, on top of the model alone

 private:
  // One press cannot tell a sensor that is not straight from a material that stiffens, but a sensor
  // is a sensor.
  std::string unlike_a_sensor(const Model& model, const Effect& effect) const {
    if (effect.card().name != "sensor-curve") return "";
    Model straight = model;
    std::erase_if(straight.parameters,
                  [&](const Parameter& p) { return p.effect == effect.card().name; });
    const Selection all = all_episodes(w_.dataset);
    const Eigen::VectorXd f = model_forces(model, w_.dataset, all, *w_.body, false).f;
    const Eigen::VectorXd g = model_forces(straight, w_.dataset, all, *w_.body, false).f;
    // Off the straight line from nothing to the largest force (terminal-based linearity).
    const double full = f.cwiseAbs().maxCoeff();
    const double gain = full / g.cwiseAbs().maxCoeff();
    const double bend = (f - gain * g).cwiseAbs().maxCoeff() / full;
    if (bend < kCrookedest) return "";
    return fmt::format(
        "a force sensor that is {:.0f} % of its reading off a straight line is none: "
        "a material or a contact that stiffens does that",
        100 * bend);
  }

  const Set* keep(const Names& names, const FitResult& fitted) {
    const Selection all = all_episodes(w_.dataset);
    Set set{names, fitted,
            measured_forces(w_.dataset, all) -
                model_forces(fitted.model, w_.dataset, all, *w_.body, false).f,
            fitted.model.free_parameters().size()};
    const Set* kept = &all_.emplace(names, std::move(set)).first->second;
    singles_ += names.size() == 1;
    if (least_ == nullptr || fitted.rmse < least_->fitted.rmse) {
      least_ = kept;
      memory_ = autocorrelation_time(kept->residual, w_);
      independent_ = independent_samples(kept->residual, memory_);
    }
    return kept;
  }

  Workspace& w_;
  const DiagnoseOptions& options_;
  bool departs_;
  std::map<Names, Set> all_;
  std::map<Names, std::string> refused_;
  std::map<std::string, std::string> lack_;  // effects that these data cannot test
  std::size_t singles_ = 0;
  const Set* least_ = nullptr;
  double memory_ = 1, independent_ = 1;
};

const Set& best_set(Sets& sets, const Gates& gates) {
  const Set* best = sets.find({});
  std::vector<const Set*> beam{best};
  for (int level = 0; level < gates.most_effects && !beam.empty(); ++level) {
    std::vector<const Set*> next;
    for (const Set* set : beam)
      for (const Effect* effect : sets.growth(*set))
        if (const Set* grown = sets.grown(*set, *effect);
            grown != nullptr && std::find(next.begin(), next.end(), grown) == next.end())
          next.push_back(grown);
    std::vector<std::pair<double, const Set*>> ranked;
    for (const Set* set : next) ranked.emplace_back(sets.criterion(*set), set);
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
Finding judged(const Effect& effect, const Set& with_it, const Set& without_it, std::size_t tried,
               Workspace& w) {
  const Baseline base{without_it.fitted, {}};
  Candidate candidate{&effect, with_it.fitted, {}, without_it.fitted.model.has(effect.card().name)};
  const Yardstick yardstick = make_yardstick(base, {candidate}, w);
  const Measured m = measure(candidate, base, yardstick, w);
  Finding f;
  f.effect = effect.card().name;
  f.one_more_term = candidate.one_more_term;
  f.rmse_now = without_it.fitted.rmse;
  f.rmse_after = with_it.fitted.rmse;
  f.held_out_now = f.held_out_after = std::nan("");
  f.p_value = std::min(1.0, 2 * m.p_by_size * static_cast<double>(tried));
  f.criterion_gain = yardstick.residual.squaredNorm() - m.sum_of_squares - m.penalty;
  f.memory = m.memory;
  const double noise = w.noise.value * w.noise.value;
  const double beyond_noise = f.rmse_now * f.rmse_now - noise;
  if (beyond_noise > 0.01 * noise)
    f.share = std::clamp((f.rmse_now * f.rmse_now - f.rmse_after * f.rmse_after) / beyond_noise,
                         0.0, 1.0);
  f.where = describe_where(candidate, w);
  f.evidence = describe_evidence(candidate, m, f);
  f.next_measurement = effect.card().separated_by;
  return f;
}

bool passes(const Finding& f, const Gates& gates) {
  return f.criterion_gain > gates.criterion_gain && f.p_value < kFalseAlarms &&
         f.share >= gates.share;
}

struct Member {
  Finding finding;
  const Set* rest;  // the set without it
};

// Of several terms first the effect as a whole, then each further term. The largest first.
std::vector<Member> members_of(const Set& set, Sets& sets, Workspace& w) {
  std::vector<Member> members;
  for (std::size_t i = 0; i < set.added.size(); ++i) {
    const std::string& name = set.added[i];
    Names rest = set.added;
    if (i > 0 && set.added[i - 1] == name)
      rest = without(rest, name);
    else
      std::erase(rest, name);
    const Set* found = sets.find_below(rest);
    members.push_back({judged(require_effect(name), set, *found, sets.tried(), w), found});
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

// Without a second press the form of a curve alone tells effects apart, and laws are forms for many
// materials: an effect that the member's card lists as taken for it is a rival as long as what it
// leaves is less than this share of what it changes.
constexpr double kOfAnyForm = 0.25;

bool confounds(const Effect& effect, const Effect& with) {
  const auto& list = effect.card().confounders;
  return std::find(list.begin(), list.end(), with.card().name) != list.end();
}

// What can take a member's place.
std::vector<Rival> rivals_of(const Member& member, const Set& best, Sets& sets, const Gates& gates,
                             Workspace& w) {
  const Effect& own = require_effect(member.finding.effect);
  std::vector<Rival> rivals;
  for (const Effect* effect : sets.growth(*member.rest)) {
    if (effect == &own || contains(*effect, own.card().name) || contains(own, effect->card().name))
      continue;
    const Set* other = sets.grown(*member.rest, *effect);
    if (other == nullptr || sets.criterion(*other) > sets.criterion(best) + gates.criterion_gain)
      continue;
    rivals.push_back({judged(*effect, *other, *member.rest, sets.tried(), w), other->fitted.model});
  }
  return rivals;
}

}  // namespace

FewPresses diagnose_few_presses(const Baseline& base, Workspace& w,
                                const DiagnoseOptions& options) {
  const Gates& gates = options.gates;
  Sets sets(base, w, options);
  const Set* best = &best_set(sets, gates);
  FewPresses result;

  std::vector<Member> members = members_of(*best, sets, w);
  while (!members.empty() && !passes(members.back().finding, gates)) {
    best = sets.find_below(without(best->added, members.back().finding.effect));
    members = members_of(*best, sets, w);
  }

  result.end = best->fitted;
  Names settled;
  for (Member& member : members) {
    Finding& f = member.finding;
    f.verdict = Verdict::kMissing;
    settled.push_back(f.effect);
    std::vector<Rival> rivals = rivals_of(member, *best, sets, gates, w);
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
    const Set* more = sets.grown(*best, *effect);
    if (more == nullptr) {
      Finding f;
      f.effect = effect->card().name;
      f.rmse_now = f.rmse_after = best->fitted.rmse;
      f.held_out_now = f.held_out_after = std::nan("");
      f.evidence = sets.refusal(*best, *effect);
      f.next_measurement = effect->card().separated_by;
      result.findings.push_back(f);
      continue;
    }
    Finding f = judged(*effect, *more, *best, sets.tried(), w);
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
    f.evidence = lacking_for(card, w.dataset);
    if (f.evidence.empty() && needs_many(card))
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
