#include "effects/memory_terms.h"

namespace hapsim {
namespace {

class MemoryEffectStep : public EffectStep {
 public:
  explicit MemoryEffectStep(std::vector<MaxwellTerm> terms) : steps_(std::move(terms)) {}
  std::size_t memory() const override { return steps_.size(); }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    const Vec3 driver = f;
    steps_.add(sample, driver, memory, f);
  }

 private:
  MemorySteps steps_;
};

}  // namespace

void add_memory(const PressView& press, const std::vector<MemoryTerm>& terms, const Signal& driver,
                Signal& signal) {
  if (press.t.empty()) return;
  const Eigen::Index columns = signal.df.cols();
  const auto n = static_cast<Eigen::Index>(press.size());
  for (const MemoryTerm& term : terms) {
    Eigen::Vector3d h = driver.f.head<3>(), dh_dtau = Eigen::Vector3d::Zero();
    Eigen::MatrixXd dh = driver.df.topRows(3);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i > 0) {
        const auto j = static_cast<std::size_t>(i);
        const MemoryStep s = memory_step(press.t[j] - press.t[j - 1], term.tau);
        const Eigen::Vector3d change = driver.f.segment<3>(3 * i) - driver.f.segment<3>(3 * i - 3);
        dh_dtau = s.a * dh_dtau + s.da_dtau * h + s.dc_dtau * change;
        h = s.a * h + s.c * change;
        if (columns > 0)
          dh = s.a * dh +
               s.c * (driver.df.middleRows(3 * i, 3) - driver.df.middleRows(3 * i - 3, 3));
      }
      signal.f.segment<3>(3 * i) += term.share * h;
      if (columns == 0) continue;
      signal.df.middleRows(3 * i, 3) += term.share * dh;
      for (const auto& [column, by] : term.share_by) signal.df.block<3, 1>(3 * i, column) += by * h;
      for (const auto& [column, by] : term.tau_by)
        signal.df.block<3, 1>(3 * i, column) += term.share * by * dh_dtau;
    }
  }
}

void MemorySteps::add(const StepSample& sample, const Vec3& driver, double* memory,
                      Vec3& f) noexcept {
  if (!sample.first && (sample.dt != dt_ || sample.times != times_)) {
    dt_ = sample.dt;
    times_ = sample.times;
    for (std::size_t k = 0; k < terms_.size(); ++k)
      decay_[k] = memory_step(dt_, times_ * terms_[k].tau);
  }
  Eigen::Map<Vec3> before(memory);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    Eigen::Map<Vec3> h(memory + 3 * (k + 1));
    if (sample.first)
      h = driver;
    else
      h = decay_[k].a * h + decay_[k].c * (driver - before);
    f += sample.moduli * terms_[k].share * h;
  }
  before = driver;
}

std::unique_ptr<EffectStep> memory_effect_step(std::vector<MaxwellTerm> terms) {
  return std::make_unique<MemoryEffectStep>(std::move(terms));
}

std::vector<MaxwellTerm> plain_terms(const std::vector<MemoryTerm>& terms) {
  std::vector<MaxwellTerm> plain;
  plain.reserve(terms.size());
  for (const MemoryTerm& term : terms) plain.push_back({term.share, term.tau});
  return plain;
}

}  // namespace hapsim
