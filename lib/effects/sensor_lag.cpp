// A force sensor that follows with a first-order lag, or whose readings come late.
#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "material/maxwell_memory.h"

namespace hapsim {
namespace {

// The force a dead time ago, straight between samples: remembers the first force of the press and
// those since then.
class DeadTime {
 public:
  explicit DeadTime(double delay) : delay_(delay) {}
  std::size_t memory() const { return delay_ > 0 ? 5 + 4 * kMost : 0; }
  void apply(const StepSample& sample, double* memory, Vec3& f) const noexcept {
    if (delay_ <= 0) return;
    double &head = memory[0], &count = memory[1];
    Eigen::Map<Vec3> first(memory + 2);
    double* ring = memory + 5;
    if (sample.first) {
      head = count = 0;
      first = f;
    }
    if (count == static_cast<double>(kMost)) drop(head, count);
    double* now = entry(ring, head + count);
    now[0] = sample.t;
    Eigen::Map<Vec3>(now + 1) = f;
    ++count;
    if (sample.first) return;
    const double t = sample.t - delay_;
    if (t <= 0) {
      f = first;
      return;
    }
    while (count > 2 && entry(ring, head + 1)[0] < t) drop(head, count);
    const double *before = entry(ring, head), *after = entry(ring, head + 1);
    const double w = std::max(0.0, (t - before[0]) / (after[0] - before[0]));
    f = (1 - w) * Eigen::Map<const Vec3>(before + 1) + w * Eigen::Map<const Vec3>(after + 1);
  }

 private:
  static constexpr std::size_t kMost = 16384;
  static double* entry(double* ring, double at) {
    return ring + 4 * (static_cast<std::size_t>(at) % kMost);
  }
  static void drop(double& head, double& count) {
    head = head + 1 < static_cast<double>(kMost) ? head + 1 : 0;
    --count;
  }
  double delay_;
};

// Remembers the delayed force, what the filter has not let through of it, and the dead time's.
class SensorLagStep : public EffectStep {
 public:
  SensorLagStep(double tau, double delay) : tau_(tau), dead_time_(delay) {}
  std::size_t memory() const override { return 6 + dead_time_.memory(); }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> h(memory), before(memory + 3);
    dead_time_.apply(sample, memory + 6, f);
    const Vec3 now = f;
    if (sample.first) {
      h.setZero();
    } else if (tau_ > 0) {
      const MemoryStep s = memory_step(sample.dt, tau_);
      h = s.a * h + s.c * (now - before);
      f -= h;
    }
    before = now;
  }

 private:
  double tau_;
  DeadTime dead_time_;
};

class SensorLag : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "sensor-lag",
        .stage = Stage::kSensor,
        .title = "the force sensor lags behind",
        .equation =
            "f_measured = g - h, dh/dt = dg/dt - h/tau, g(t) = f(t - delay): first-order low pass "
            "behind a dead time, exact for forces that are straight between samples",
        .source = "first-order filter; same recursion as thesis (3.54)-(3.55)",
        .assumptions = "one time constant and one delay for all axes; settled before each press",
        .parameters = {{"tau", "s", "time constant", 0, 0.02, 1e-5, 10, 0.02, true},
                       {"delay", "s", "dead time: how late forces are recorded", 0, 0, 0, 10, 0.02,
                        false, std::numeric_limits<double>::quiet_NaN(), false, true}},
        .needs_time = true,
        .signature = "too soft an instant after each change of speed, right at rest",
        .confounders = {"damper", "viscoelastic"},
        .separated_by = "a fast press where the stiffness differs",
        .kinds = {"history", "rate", "contact-time"},
        .live = "a delay of more than 16,384 samples is one of so many"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.t.empty()) return;
    set_back(press, find_value(values, "delay"), signal);
    const ParameterValue& tau = find_value(values, "tau");
    if (tau.value <= 0) return;
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    Eigen::Vector3d h = Eigen::Vector3d::Zero(), dh_dtau = h;
    Eigen::MatrixXd dh = Eigen::MatrixXd::Zero(3, df.cols());
    for (Eigen::Index i = 1; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const MemoryStep s = memory_step(press.t[i] - press.t[i - 1], tau.value);
      const Eigen::Vector3d change = f.segment<3>(3 * i) - f.segment<3>(3 * i - 3);
      dh_dtau = s.a * dh_dtau + s.da_dtau * h + s.dc_dtau * change;
      h = s.a * h + s.c * change;
      signal.f.segment<3>(3 * i) -= h;
      if (df.cols() == 0) continue;
      dh = s.a * dh + s.c * (df.middleRows(3 * i, 3) - df.middleRows(3 * i - 3, 3));
      signal.df.middleRows(3 * i, 3) -= dh;
      if (tau.column >= 0) signal.df.block<3, 1>(3 * i, tau.column) -= dh_dtau;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<SensorLagStep>(find_value(values, "tau").value,
                                           find_value(values, "delay").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double step = std::max(data.sample_step, 1e-3);
    return {{step, 0}, {5 * step, 0}, {0.3 * step, 2.5 * step}};
  }

 private:
  // Each sample takes what was the force a delay ago, straight between samples.
  static void set_back(const PressView& press, const ParameterValue& delay, Signal& signal) {
    if (delay.value <= 0 && delay.column < 0) return;
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    Eigen::Index before = 0;
    for (std::size_t i = 1; i < press.size(); ++i) {
      const double t = press.t[i] - delay.value;
      const auto row = 3 * static_cast<Eigen::Index>(i);
      if (t <= press.t.front()) {
        signal.f.segment<3>(row) = f.head<3>();
        if (df.cols() > 0) signal.df.middleRows(row, 3) = df.topRows(3);
        continue;
      }
      while (press.t[static_cast<std::size_t>(before) + 1] < t) ++before;
      const double dt =
          press.t[static_cast<std::size_t>(before) + 1] - press.t[static_cast<std::size_t>(before)];
      const double w = (t - press.t[static_cast<std::size_t>(before)]) / dt;
      const Eigen::Index at = 3 * before;
      signal.f.segment<3>(row) = (1 - w) * f.segment<3>(at) + w * f.segment<3>(at + 3);
      if (df.cols() > 0)
        signal.df.middleRows(row, 3) =
            (1 - w) * df.middleRows(at, 3) + w * df.middleRows(at + 3, 3);
      if (delay.column >= 0)
        signal.df.block<3, 1>(row, delay.column) -= (f.segment<3>(at + 3) - f.segment<3>(at)) / dt;
    }
  }
};

}  // namespace

const Effect& sensor_lag_effect() {
  static const SensorLag effect;
  return effect;
}

}  // namespace hapsim
