#include "explore/goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/counted.h"
#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/experiment.h"

namespace hapsim {
namespace {

// A fit that ends at a bound tells no error.
bool at_bound(const Parameter& p) {
  const double near = 1e-6 * std::max(std::abs(p.value), p.upper - p.lower);
  return p.state == ParameterState::kFree && !std::isfinite(p.std_error) &&
         (p.value <= p.lower + near || p.value >= p.upper - near);
}

std::string label_of(const Parameter& p) {
  return p.effect + " " + p.name + (p.region > 0 ? fmt::format(" of region {}", p.region) : "");
}

bool is_modulus(const std::string& effect, const std::string& name) {
  return name == body_effect().card().modulus &&
         (effect.empty() || effect == body_effect().card().name);
}

std::string beyond_words(double floor) {
  return fmt::format(
      "no number of presses makes it better than {:.2g} %: by so much mesh and shape may err "
      "everywhere alike",
      100 * floor);
}

// The less that is known of it, the worse: nothing known is worst.
bool worse(double a, double b) {
  return std::isnan(a) ? !std::isnan(b) : a > b;
}

void hold_to_bounds(const Model& model, const Parameter& p, GoalState& state) {
  const Parameter* stuck = at_bound(p) ? &p : nullptr;
  const EffectCard& body = body_effect().card();
  for (const Parameter& other : model.parameters)
    if (stuck == nullptr && p.effect == body.name && other.effect == body.name &&
        other.name == body.poissons_ratio && at_bound(other))
      stuck = &other;
  if (stuck == nullptr) return;
  state.reached = false;
  state.determine = stuck->effect + " " + stuck->name;
  state.region = stuck->region;
  state.note = fmt::format("{} is at its bound, {:.3g}; {}", label_of(*stuck), stuck->value,
                           stuck == &p ? "no error can be told" : "the error holds there alone");
}

}  // namespace

std::string unsettled(const Diagnosis& d, const Coverage& coverage) {
  std::string why;
  const auto also = [&](const std::string& reason) { why += (why.empty() ? "" : "; ") + reason; };
  if (coverage.presses < kLeastPresses) also(fmt::format("{} presses are needed", kLeastPresses));
  if (coverage.places < kSettledPlaces)
    also(fmt::format("presses lie at {} a tool's radius apart, {} are needed",
                     counted(coverage.places, "place", "places"), kSettledPlaces));
  for (const LackingMotion& m : coverage.lacking) also(m.what);
  const bool left = !d.left.noise_alone() || !d.torque.explained() || !d.marker.explained();
  if (d.verdict == ModelVerdict::kIncomplete && left) also("what is found does not explain all");
  if (d.verdict == ModelVerdict::kAmbiguous) also("effects do equally well");
  if (d.verdict == ModelVerdict::kUnexplained) also("no effect explains what is left");
  return why;
}

GoalState verdict_state(const Diagnosis& d, const Coverage& coverage) {
  std::string names;
  for (const Finding& f : d.findings) {
    const bool rival = f.verdict == Verdict::kIndistinguishable;
    if (f.verdict != Verdict::kMissing && !rival) continue;
    names += (names.empty() ? ": " : rival ? " | " : " + ") + f.effect;
  }
  GoalState state{"verdict", verdict_name(d.verdict) + names};
  state.note = unsettled(d, coverage);
  state.reached = state.note.empty();
  return state;
}

std::optional<GoalState> hopeless(const WantedError& wanted, double floor) {
  const std::size_t dot = wanted.parameter.find('.');
  const bool full = dot != std::string::npos;
  if (!(wanted.share < floor) || !is_modulus(full ? wanted.parameter.substr(0, dot) : "",
                                             wanted.parameter.substr(full ? dot + 1 : 0)))
    return std::nullopt;
  GoalState state{wanted.parameter, "", std::nan(""), wanted.share};
  state.unreachable = true;
  state.note = beyond_words(floor);
  return state;
}

GoalState error_state(const WantedError& wanted, const Model& model, double floor) {
  GoalState state{wanted.parameter, "", -1, wanted.share};
  const Parameter* worst = nullptr;
  for (const int k : model.free_parameters()) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(k)];
    if (p.name != wanted.parameter && p.effect + "." + p.name != wanted.parameter) continue;
    const double error = std::abs(p.std_error / p.value);
    // Of several regions the least certain.
    if (worst != nullptr && !worse(error, state.value)) continue;
    worst = &p;
    state.value = error;
  }
  if (worst == nullptr)
    fail_usage(fmt::format("the model that the presses ask for has no free parameter {}",
                           wanted.parameter),
               "ask for one that it has, or leave it out of the goals");
  state.name = state.determine = worst->effect + " " + worst->name;
  state.region = worst->region;
  state.reached = state.value <= wanted.share;
  hold_to_bounds(model, *worst, state);
  if (is_modulus(worst->effect, worst->name) && wanted.share < floor) {
    state.reached = false;
    state.unreachable = true;
    state.note = beyond_words(floor);
  }
  return state;
}

GoalState unseen_state(const WantedUnseen& wanted, const Unseen& unseen, double floor) {
  GoalState state{"unseen", wanted.of_force ? "of force" : "of noise",
                  wanted.of_force ? unseen.share_of_force : unseen.times_noise, wanted.value};
  state.reached = state.value <= wanted.value;
  state.unreachable = !state.reached && unseen.share_of_force <= floor;
  if (state.unreachable)
    state.note = fmt::format(
        "what is left is {:.2g} % of the force, no more than mesh and shape may "
        "err by everywhere ({:.2g} %)",
        100 * unseen.share_of_force, 100 * floor);
  return state;
}

GoalState lump_state(double wanted, const StiffnessImage& image) {
  if (image.lumps.empty())
    return {"lump", "not seen", std::numeric_limits<double>::quiet_NaN(), wanted, false};
  const Lump& lump = image.lumps.front();
  double widest = 0;
  for (const Interval* i : {&lump.x, &lump.y, &lump.z})
    widest = std::max(widest, (i->high - i->low) / 2);
  return {"lump", "seen", widest, wanted, widest <= wanted};
}

}  // namespace hapsim
