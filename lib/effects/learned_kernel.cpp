// A memory of what was pressed before, of any form, as learned.
#include <array>
#include <cmath>

#include "effects/effects.h"
#include "effects/memory_terms.h"

namespace hapsim {
namespace {

constexpr std::size_t kMemoryTimes = 6;
using MemoryShares = std::array<double, kMemoryTimes>;

struct MemoryKernel {
  MemoryShares g{}, tau{};

  explicit MemoryKernel(const Values& values) {
    const double shortest = find_value(values, "shortest").value;
    const double longest = find_value(values, "longest").value;
    for (std::size_t k = 0; k < kMemoryTimes; ++k) {
      g[k] = find_value(values, name_of(k)).value;
      tau[k] = shortest * std::pow(longest / shortest,
                                   static_cast<double>(k) / static_cast<double>(kMemoryTimes - 1));
    }
  }
  static std::string name_of(std::size_t k) { return "g" + std::to_string(k + 1); }
};

ParameterCard memory_share(int k) {
  return {"g" + std::to_string(k),
          "1",
          "share of the force that is forgotten at that time",
          0,
          0.05,
          -1,
          1e3,
          0.05,
          false};
}

class LearnedKernel : public Effect {
 public:
  const EffectCard& card() const override {
    constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();
    static const EffectCard card{
        .name = "learned-kernel",
        .stage = Stage::kContact,
        .title = "the force remembers what was pressed before, by a law of its own",
        .equation =
            "f = f_before + int k(t - s) df_before(s), k(t) = sum_i g_i exp(-t / tau_i), tau_1 to "
            "tau_6 from shortest to longest in equal ratios",
        .source =
            "a relaxation spectrum at given times (Tschoegl, The Phenomenological Theory of "
            "Linear Viscoelastic Behavior, 1989)",
        .assumptions =
            "linear in the force before it, alike at every place and depth; relaxed before each "
            "press; shares below 0 are creep of the set-up",
        .parameters = {memory_share(1),
                       memory_share(2),
                       memory_share(3),
                       memory_share(4),
                       memory_share(5),
                       memory_share(6),
                       {"shortest", "s", "tau_1", 0.1, 0.1, 1e-6, 1e6, 1, true, kNoLimit, true},
                       {"longest", "s", "tau_6", 10, 10, 1e-6, 1e6, 1, true, kNoLimit, true}},
        .needs_time = true,
        .form_error = 0.05,
        .learned = true,
        .signature = "an error that follows the time since the tool moved, by no law that is known",
        .confounders = {"viscoelastic", "qlv", "damper", "sensor-lag", "filter",
                        "sensor-hysteresis", "softening"},
        .separated_by = "the same press at three speeds, with a hold ten times as long",
        .contains = {"viscoelastic"},
        .kinds = {"history", "contact-time", "rate", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const MemoryKernel kernel(values);
    std::vector<MemoryTerm> terms;
    for (std::size_t k = 0; k < kMemoryTimes; ++k) {
      MemoryTerm& term = terms.emplace_back();
      term.share = kernel.g[k];
      term.tau = kernel.tau[k];
      const int column = find_value(values, MemoryKernel::name_of(k)).column;
      if (column >= 0) term.share_by.emplace_back(column, 1);
    }
    add_memory(press, terms, Signal(signal), signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const MemoryKernel kernel(values);
    std::vector<MaxwellTerm> terms;
    for (std::size_t k = 0; k < kMemoryTimes; ++k) terms.push_back({kernel.g[k], kernel.tau[k]});
    return memory_effect_step(std::move(terms));
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const MemoryKernel kernel(values);
    EffectCurve curve{"", "time", "s", "share", "1", {}};
    for (int i = 0; i < kPoints; ++i) {
      const double t = kernel.tau.front() * std::pow(kernel.tau.back() / kernel.tau.front(),
                                                     static_cast<double>(i) / (kPoints - 1));
      CurvePoint point{t, 0, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
      for (std::size_t k = 0; k < kMemoryTimes; ++k) {
        const double left = std::exp(-t / kernel.tau[k]);
        point.y += kernel.g[k] * left;
        point.by[static_cast<Eigen::Index>(k)] = left;
      }
      curve.points.push_back(std::move(point));
    }
    return {curve};
  }

  // From half a sample, which does what a damper does, to a whole press: longer ones are not seen.
  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double shortest = std::max(0.5 * data.sample_step, 2.5e-4);
    const double longest = std::max(data.press_duration, 128 * shortest);
    return {{0.05, 0.05, 0.05, 0.05, 0.05, 0.05, shortest, longest}};
  }
};

}  // namespace

const Effect& learned_kernel_effect() {
  static const LearnedKernel effect;
  return effect;
}

}  // namespace hapsim
