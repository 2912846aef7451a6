// Liquid that is pressed out of a porous body, the more slowly the larger the tool.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"
#include "effects/maxwell_spectrum.h"
#include "effects/memory_terms.h"

namespace hapsim {
namespace {

// g(x) = 1.304 exp(-sqrt x) - 0.304 exp(-0.254 x), x = D t / a^2.
constexpr double kOfRoot = 1.304, kExponential = 0.254;

std::vector<MemoryTerm> draining_terms(const Values& values, double radius) {
  const ParameterValue& drained = find_value(values, "nu_d");
  const ParameterValue& diffusivity = find_value(values, "D");
  const MaxwellSpectrum& spectrum = square_root_spectrum();
  const double share = 1 - 2 * drained.value;
  const double time = radius * radius / diffusivity.value;
  std::vector<MemoryTerm> terms;
  const auto add = [&](double weight, double rate) {
    MemoryTerm& term = terms.emplace_back();
    term.share = share * weight;
    term.tau = time / rate;
    if (drained.column >= 0) term.share_by.emplace_back(drained.column, -2 * weight);
    if (diffusivity.column >= 0)
      term.tau_by.emplace_back(diffusivity.column, -term.tau / diffusivity.value);
  };
  for (std::size_t i = 0; i < MaxwellSpectrum::kSize; ++i)
    add(kOfRoot * spectrum.weight[i], spectrum.rate[i]);
  add(1 - kOfRoot, kExponential);
  return terms;
}

class Poroelastic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "poroelastic",
        .stage = Stage::kBody,
        .title = "liquid moves in the body while it is pressed",
        .equation =
            "f = f_e + (1 - 2 nu_d) int g(D (t - s) / a^2) df_e(s), g(x) = 1.304 exp(-sqrt x) - "
            "0.304 exp(-0.254 x), a the tool's radius",
        .source =
            "flat punch on a porous half-space: Hu, Zhao, Vlassak and Suo, Appl. Phys. Lett. 96, "
            "121904, 2010",
        .assumptions =
            "a flat tool whose face lets no liquid through, a body that is large beside it; "
            "sideways forces relax alike; E and nu are those of the drained body; of a ball a is "
            "the radius of its contact, and the form differs by some hundredths",
        .parameters = {{"nu_d", "1",
                        "Poisson's ratio of the drained skeleton as the relaxation tells it: from "
                        "1 to 2 - 2 nu_d times the drained force",
                        0.5, 0.4, -0.5, 0.5, 0.05, false},
                       {"D", "m^2/s", "diffusivity of the liquid in the body", 1e-6, 1e-6, 1e-14, 1,
                        1e-6, true}},
        .needs_time = true,
        .among_presses = true,
        .form_error = 0.03,
        .screened = true,
        .signature =
            "too soft in fast loading, too stiff late in holds, and later so under a larger tool",
        .confounders = {"viscoelastic", "fractional", "learned-kernel", "sensor-lag"},
        .separated_by =
            "the same press with tools of two radii: the time grows with the square of the radius; "
            "a hold until the force stays",
        .contains = {"viscoelastic"},
        .kinds = {"history", "contact-time", "rate", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    add_memory(press, draining_terms(values, press.radius), Signal(signal), signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    return memory_effect_step(plain_terms(draining_terms(values, context.tool_radius)));
  }

  // From what is over within a sample to what has hardly begun at a press's end.
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    const double area = data.tool_radius * data.tool_radius;
    if (data.press_duration > 0) limits[1].first = 0.01 * area / data.press_duration;
    if (data.sample_step > 0)
      limits[1].second = std::max(10 * limits[1].first, area / data.sample_step);
    return limits;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double area = data.tool_radius * data.tool_radius;
    const double press = std::max(data.press_duration, 1e-3);
    return {{0.4, 0.3 * area / press}, {0.4, 5 * area / press}};
  }
};

}  // namespace

const Effect& poroelastic_effect() {
  static const Poroelastic effect;
  return effect;
}

}  // namespace hapsim
