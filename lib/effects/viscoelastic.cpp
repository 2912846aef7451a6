// Linear viscoelasticity: a generalised Maxwell material with one Poisson's ratio.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"
#include "effects/memory_terms.h"

namespace hapsim {
namespace {

class Viscoelastic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "viscoelastic",
        .stage = Stage::kBody,
        .title = "the material relaxes with time",
        .equation =
            "f = f_e + sum_i (E_i/E) h_i, dh_i/dt = df_e/dt - h_i/tau_i: generalised "
            "Maxwell material with common Poisson's ratio, exact between samples",
        .source = "thesis (3.51)-(3.56); Simo and Hughes, Computational Inelasticity, ch. 10",
        .assumptions =
            "relaxed before each press; shear and bulk relax alike; the same relative "
            "relaxation in every region",
        .parameters = {{"E1", "Pa", "modulus that relaxes away", 0, 5e3, 0, 1e12, 1e4, false},
                       {"tau1", "s", "its relaxation time", 1, 0.5, 1e-4, 1e5, 1, true}},
        .terms = true,
        .needs_time = true,
        .maxwell = true,
        .signature = "too soft in fast loading, too stiff late in holds and in unloading",
        .confounders = {"damper", "sensor-lag", "sensor-drift", "softening"},
        .separated_by = "a fast press and a long hold at the same place and depth",
        .kinds = {"history", "contact-time", "rate", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    std::vector<MemoryTerm> terms;
    for (std::size_t k = 0; k + 1 < values.size(); k += 2) {
      const ParameterValue &modulus = values[k], &tau = values[k + 1];
      MemoryTerm& term = terms.emplace_back();
      term.share = modulus.value / press.modulus;
      term.tau = tau.value;
      if (press.modulus_column >= 0)
        term.share_by.emplace_back(press.modulus_column, -term.share / press.modulus);
      if (modulus.column >= 0) term.share_by.emplace_back(modulus.column, 1 / press.modulus);
      if (tau.column >= 0) term.tau_by.emplace_back(tau.column, 1);
    }
    add_memory(press, terms, Signal(signal), signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    std::vector<MaxwellTerm> terms;
    relaxation(values, context.modulus, terms);
    return memory_effect_step(std::move(terms));
  }

  bool relaxation(const Values& values, double modulus,
                  std::vector<MaxwellTerm>& terms) const override {
    for (std::size_t k = 0; k + 1 < values.size(); k += 2)
      terms.push_back({values[k].value / modulus, values[k + 1].value});
    return true;
  }

  // A time shorter than the samples' step shows in its product with E1 alone: that is a damper.
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    limits[1].first = std::max(limits[1].first, data.sample_step);
    return limits;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int terms) const override {
    // Relaxation times spread over what the data can see, from two samples to a press.
    const double low = std::max(2 * data.sample_step, 1e-3);
    const double high = std::max(4 * low, data.press_duration);
    std::vector<std::vector<double>> result;
    for (const double shift : {0.15, 0.4, 0.65, 0.9}) {
      std::vector<double> start;
      for (int k = 0; k < terms; ++k) {
        const double where = terms == 1 ? shift : (k + shift) / terms;
        start.push_back(0.5 * data.modulus / terms);
        start.push_back(low * std::pow(high / low, where));
      }
      result.push_back(start);
    }
    return result;
  }
};

}  // namespace

const Effect& viscoelastic_effect() {
  static const Viscoelastic effect;
  return effect;
}

}  // namespace hapsim
