// Relaxation whose share depends on the depth.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"
#include "effects/memory_terms.h"

namespace hapsim {
namespace {

// (q/a)^m, and its derivatives by m and by q.
struct DepthPower {
  double value = 0, by_m = 0, by_q = 0;
};
DepthPower depth_power(double q, double a, double m) {
  DepthPower p;
  if (q <= 0) {
    p.value = m == 0 ? 1 : 0;
    return p;
  }
  p.value = std::pow(q / a, m);
  p.by_m = p.value * std::log(q / a);
  p.by_q = m * p.value / q;
  return p;
}

// Remembers the driver, then the memory.
class QlvStep : public EffectStep {
 public:
  QlvStep(const MaxwellTerm& term, double m, double radius)
      : steps_({term}), m_(m), radius_(radius) {}
  std::size_t memory() const override { return steps_.size(); }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    const Vec3 driver = depth_power(sample.u.norm(), radius_, m_).value * f;
    steps_.add(sample, driver, memory, f);
  }

 private:
  MemorySteps steps_;
  double m_, radius_;
};

class Qlv : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "qlv",
        .stage = Stage::kBody,
        .title = "the material relaxes with time, by another share at another depth",
        .equation =
            "f = f_e + (Eq/E) h, dh/dt = dg/dt - h/tau, g = (|u|/a)^m f_e, a the tool's radius: "
            "what relaxes is of another power of the depth than what stays",
        .source =
            "quasi-linear viscoelasticity: Fung, Biomechanics, 1993, ch. 7; superposition modified "
            "by strain: Findley, Lai and Onaran, 1976; Provenzano et al., Biomech. Model. "
            "Mechanobiol. 1, 2002",
        .assumptions =
            "relaxed before each press; one time of relaxation; a power of the depth, the same "
            "everywhere",
        .parameters = {{"Eq", "Pa", "modulus that relaxes away at a depth of one tool radius", 0,
                        5e3, 0, 1e12, 1e4, false},
                       {"tau", "s", "its relaxation time", 1, 0.5, 1e-4, 1e5, 1, true},
                       {"m", "1", "power of the depth: 0 linear, above 0 deeper presses relax more",
                        0, 0.5, -0.9, 4, 0.3, false}},
        .needs_time = true,
        .among_presses = true,
        .form_error = 0.1,
        .screened = true,
        .signature =
            "the share that relaxes differs between shallow and deep presses, or along one",
        .confounders = {"viscoelastic", "hyperelastic", "learned-kernel", "softening"},
        .separated_by = "holds at three depths, each until the force stays",
        .contains = {"viscoelastic"},
        .kinds = {"history", "contact-time", "rate", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& modulus = find_value(values, "Eq");
    const ParameterValue& tau = find_value(values, "tau");
    const ParameterValue& m = find_value(values, "m");
    Signal driver = signal;
    for (std::size_t i = 0; i < press.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const double q = press.u[i].norm();
      const DepthPower p = depth_power(q, press.radius, m.value);
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      driver.f.segment<3>(row) *= p.value;
      if (signal.df.cols() == 0) continue;
      driver.df.middleRows(row, 3) *= p.value;
      if (m.column >= 0) driver.df.block<3, 1>(row, m.column) += p.by_m * f;
      if (press.du.cols() > 0 && q > 0)
        driver.df.middleRows(row, 3) +=
            p.by_q * f * (press.u[i].transpose() / q * press.du.middleRows(row, 3));
    }
    MemoryTerm term;
    term.share = modulus.value / press.modulus;
    term.tau = tau.value;
    if (press.modulus_column >= 0)
      term.share_by.emplace_back(press.modulus_column, -term.share / press.modulus);
    if (modulus.column >= 0) term.share_by.emplace_back(modulus.column, 1 / press.modulus);
    if (tau.column >= 0) term.tau_by.emplace_back(tau.column, 1);
    add_memory(press, {term}, driver, signal);
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    const MaxwellTerm term{find_value(values, "Eq").value / context.modulus,
                           find_value(values, "tau").value};
    return std::make_unique<QlvStep>(term, find_value(values, "m").value, context.tool_radius);
  }

  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    limits[1].first = std::max(limits[1].first, data.sample_step);
    return limits;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double low = std::max(2 * data.sample_step, 1e-3);
    const double high = std::max(4 * low, data.press_duration);
    return {{0.5 * data.modulus, low * std::pow(high / low, 0.3), 0.7},
            {0.5 * data.modulus, low * std::pow(high / low, 0.7), 0.7}};
  }
};

}  // namespace

const Effect& qlv_effect() {
  static const Qlv effect;
  return effect;
}

}  // namespace hapsim
