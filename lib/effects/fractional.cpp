// A memory that fades by a power of time: fractional viscoelasticity.
#include <algorithm>

#include "effects/effects.h"
#include "effects/maxwell_spectrum.h"
#include "effects/memory_terms.h"

namespace hapsim {
namespace {

// For the modulus `body` of the material, in column `body_column`.
std::vector<MemoryTerm> power_law_terms(const Values& values, double body, int body_column) {
  const ParameterValue& modulus = find_value(values, "Ef");
  const ParameterValue& alpha = find_value(values, "alpha");
  const ParameterValue& tau0 = find_value(values, "tau0");
  const MaxwellSpectrum spectrum = power_law_spectrum(alpha.value);
  const double share = modulus.value / body;
  std::vector<MemoryTerm> terms(MaxwellSpectrum::kSize);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    MemoryTerm& term = terms[i];
    term.share = share * spectrum.weight[i];
    term.tau = tau0.value / spectrum.rate[i];
    if (body_column >= 0) term.share_by.emplace_back(body_column, -term.share / body);
    if (modulus.column >= 0) term.share_by.emplace_back(modulus.column, spectrum.weight[i] / body);
    if (alpha.column >= 0) term.share_by.emplace_back(alpha.column, share * spectrum.by_shape[i]);
    if (tau0.column >= 0) term.tau_by.emplace_back(tau0.column, 1 / spectrum.rate[i]);
  }
  return terms;
}

class Fractional : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "fractional",
        .stage = Stage::kBody,
        .title = "the material relaxes by a power of time, without a time of its own",
        .equation =
            "f = f_e + (Ef/E) int k(t - s) df_e(s), k(t) = (1 + t/tau0)^-alpha, as Maxwell "
            "elements from 0.05 to 9e6 tau0, k within 1e-3 up to 1e5 tau0",
        .source =
            "Nutting, J. Franklin Inst. 191, 1921; Magin, Fractional Calculus in Bioengineering, "
            "2006; elements from the gamma density's Laplace transform",
        .assumptions =
            "relaxed before each press; shear and bulk relax alike; the same in every region; "
            "what relaxes before tau0, no shorter than a sample, is not told from what does not",
        .parameters = {{"Ef", "Pa", "modulus that relaxes away", 0, 5e3, 0, 1e12, 1e4, false},
                       {"alpha", "1", "power of time", 0.3, 0.3, 0.02, 1, 0.1, true},
                       {"tau0", "s", "time from which on the power rules", 0.05, 0.05, 1e-5, 1e4, 1,
                        true}},
        .needs_time = true,
        .among_presses = true,
        .screened = true,
        .signature =
            "too soft in fast loading and too stiff late, the more slowly the longer one waits: "
            "each tenfold time takes a like share",
        .confounders = {"viscoelastic", "poroelastic", "learned-kernel", "sensor-drift"},
        .separated_by = "a hold a hundred times as long as the way in, sampled from its beginning",
        .contains = {"viscoelastic"},
        .kinds = {"history", "contact-time", "rate", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    add_memory(press, power_law_terms(values, press.modulus, press.modulus_column), Signal(signal),
               signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    return memory_effect_step(plain_terms(power_law_terms(values, context.modulus, -1)));
  }

  bool relaxation(const Values& values, double modulus,
                  std::vector<MaxwellTerm>& terms) const override {
    if (values.empty()) return true;
    for (const MaxwellTerm& term : plain_terms(power_law_terms(values, modulus, -1)))
      terms.push_back(term);
    return true;
  }

  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    limits[2].first = std::max(limits[2].first, data.sample_step);
    return limits;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double tau0 = std::max(2 * data.sample_step, 1e-3);
    return {{0.5 * data.modulus, 0.2, tau0}, {0.5 * data.modulus, 0.7, 3 * tau0}};
  }
};

}  // namespace

const Effect& fractional_effect() {
  static const Fractional effect;
  return effect;
}

}  // namespace hapsim
