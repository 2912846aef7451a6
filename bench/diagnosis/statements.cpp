#include "statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "diagnose/candidate.h"
#include "diagnose/try_effects.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "left_out.h"
#include "made_recordings.h"

namespace hapsim::bench {
namespace {

// Whether the forces would show a change of the truth's parameter: what has no effect has no size.
bool acts(const Model& truth, const Parameter& exact, const Experiment& w) {
  Model changed = truth;
  Parameter& p = *changed.find(exact.effect, exact.region, exact.name);
  const double step = parameter_card(require_effect(exact.effect), exact.name)->scale;
  p.value += p.value + step > p.upper ? -step : step;
  const Selection all = all_episodes(w.dataset);
  const auto forces = [&](const Model& m) { return solved_forces(m, w, all, false).f; };
  return (forces(changed) - forces(truth)).norm() > kNoise;
}

}  // namespace

void append_statements(const std::string& path, const Truth& truth, const Trial& trial,
                       const Diagnosis& d) {
  std::ofstream out(path, std::ios::app);
  const auto true_of = [&](const std::string& said) {
    return std::any_of(truth.effects.begin(), truth.effects.end(), [&](const std::string& hidden) {
      return hidden == said || contains(require_effect(hidden), said) || is_of_kind(hidden, said);
    });
  };
  for (const Finding& f : d.findings)
    out << fmt::format("{},{:.3g},{},{},{},{:d},{:.4g},{:.4g},{:.5g},{:.3g},{:d}\n", truth.name,
                       trial.level, trial.seed, f.effect, verdict_name(f.verdict),
                       true_of(f.effect), f.probability, f.share_among, f.criterion_gain, f.memory,
                       d.left.noise_alone());
}

void count_sizes(const Model& found, const Model& truth, const Experiment& w,
                 const std::string& path, Trial& trial) {
  std::ofstream out(path, std::ios::app);
  const auto group = [](const Effect& effect) {
    switch (effect.card().stage) {
      case Stage::kMotion:
      case Stage::kSensor:
        return "set-up";
      case Stage::kContact:
        return "contact";
      default:
        return "material";
    }
  };
  const auto rows = [](const Model& model, const std::string& effect) {
    return std::count_if(model.parameters.begin(), model.parameters.end(),
                         [&](const Parameter& p) { return p.effect == effect; });
  };
  for (const Parameter& p : found.parameters) {
    if (rows(found, p.effect) != rows(truth, p.effect)) continue;
    if (p.state != ParameterState::kFree) continue;
    const Parameter* exact = truth.find(p.effect, p.region, p.name);
    const Effect& effect = require_effect(p.effect);
    const bool solved = effect.card().solved, elastic = p.effect == "elastic";
    if (exact == nullptr || (p.unit == "rad" && solved) || !std::isfinite(p.std_error)) continue;
    if (!solved && !elastic && !acts(truth, *exact, w)) continue;
    out << fmt::format("{},{},{},{},{},{:.8g},{:.8g},{:.4g}\n", trial.truth, trial.seed,
                       elastic ? p.name : group(effect), p.effect, p.name, p.value, exact->value,
                       p.std_error);
    if (elastic) continue;
    ++trial.sized;
    trial.covered += std::abs(p.value - exact->value) <= 1.96 * p.std_error;
  }
}

}  // namespace hapsim::bench
