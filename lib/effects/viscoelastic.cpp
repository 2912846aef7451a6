// Linear viscoelasticity: a generalised Maxwell material with one Poisson's ratio.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "material/maxwell_memory.h"

namespace hapsim {
namespace {

// Remembers the force that drives the elements, then what each has of it.
class ViscoelasticStep : public EffectStep {
 public:
  explicit ViscoelasticStep(std::vector<MaxwellTerm> terms) : terms_(std::move(terms)) {}
  std::size_t memory() const override { return 3 + 3 * terms_.size(); }

  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> before(memory);
    const Vec3 driver = f;
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      Eigen::Map<Vec3> h(memory + 3 * (k + 1));
      if (sample.first) {
        h = driver;  // relaxed until now, then a jump
      } else {
        const MemoryStep s = memory_step(sample.dt, sample.times * terms_[k].tau);
        h = s.a * h + s.c * (driver - before);
      }
      f += sample.moduli * terms_[k].share * h;
    }
    before = driver;
  }

 private:
  std::vector<MaxwellTerm> terms_;
};

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
        .separated_by = "a fast press and a long hold at the same place and depth"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.t.empty()) return;
    const Eigen::VectorXd f_e = signal.f;
    const Eigen::MatrixXd d_e = signal.df;
    const Eigen::Index columns = d_e.cols();
    const Eigen::Index n = static_cast<Eigen::Index>(press.size());
    for (std::size_t k = 0; k + 1 < values.size(); k += 2) {
      const ParameterValue& modulus = values[k];
      const ParameterValue& tau = values[k + 1];
      const double share = modulus.value / press.modulus;
      Eigen::Vector3d h = f_e.head<3>(), dh_dtau = Eigen::Vector3d::Zero();
      Eigen::MatrixXd dh = d_e.topRows(3);
      for (Eigen::Index i = 0; i < n; ++i) {
        if (i > 0) {
          const MemoryStep s = memory_step(press.t[i] - press.t[i - 1], tau.value);
          const Eigen::Vector3d change = f_e.segment<3>(3 * i) - f_e.segment<3>(3 * i - 3);
          dh_dtau = s.a * dh_dtau + s.da_dtau * h + s.dc_dtau * change;
          h = s.a * h + s.c * change;
          if (columns > 0)
            dh = s.a * dh + s.c * (d_e.middleRows(3 * i, 3) - d_e.middleRows(3 * i - 3, 3));
        }
        signal.f.segment<3>(3 * i) += share * h;
        if (columns == 0) continue;
        signal.df.middleRows(3 * i, 3) += share * dh;
        if (press.modulus_column >= 0)
          signal.df.block<3, 1>(3 * i, press.modulus_column) -= share / press.modulus * h;
        if (modulus.column >= 0) signal.df.block<3, 1>(3 * i, modulus.column) += h / press.modulus;
        if (tau.column >= 0) signal.df.block<3, 1>(3 * i, tau.column) += share * dh_dtau;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    std::vector<MaxwellTerm> terms;
    relaxation(values, context.modulus, terms);
    return std::make_unique<ViscoelasticStep>(std::move(terms));
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
