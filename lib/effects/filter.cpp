// A force sensor behind a low-pass filter of second order.
#include <algorithm>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kOpen = 1e6;  // [Hz] from there on it lets all through

// How what is left of an earlier state (y, dy/dt) about the filter's answer to a straight force
// fades over dt, and its derivatives by w = 2 pi f0 and zeta: with d = (1 - zeta^2) (w dt)^2,
//   exp(-zeta w dt) [ C + zeta w S    S            ]
//                   [ -w^2 S          C - zeta w S ],  C = cos sqrt d, S = dt sin(sqrt d) / sqrt d.
struct Fading {
  Eigen::Matrix2d phi = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d dw = Eigen::Matrix2d::Zero(), dzeta = Eigen::Matrix2d::Zero();
};

Fading fading(double dt, double w, double zeta, bool derivatives) {
  constexpr double kSeries = 1e-4;
  const double d = (1 - zeta * zeta) * w * w * dt * dt, root = std::sqrt(std::max(0.0, d));
  const double C = std::cos(root);
  const double sinc = root > 0 ? std::sin(root) / root : 1;
  const double S = dt * sinc, E = std::exp(-zeta * w * dt);
  Fading result;
  result.phi << C + zeta * w * S, S, -w * w * S, C - zeta * w * S;
  result.phi *= E;
  if (!derivatives) return result;
  const double dsinc = d < kSeries ? -1.0 / 6 + d / 60 - d * d / 1680 : (C - sinc) / (2 * d);
  Eigen::Matrix2d by_d;
  by_d << -sinc / 2 + zeta * w * dt * dsinc, dt * dsinc, -w * w * dt * dsinc,
      -sinc / 2 - zeta * w * dt * dsinc;
  by_d *= E;
  Eigen::Matrix2d by_w, by_zeta;
  by_w << zeta * S, 0, -2 * w * S, -zeta * S;
  by_zeta << w * S, 0, 0, -w * S;
  result.dw = -zeta * dt * result.phi + E * by_w + 2 * (1 - zeta * zeta) * w * dt * dt * by_d;
  result.dzeta = -w * dt * result.phi + E * by_zeta - 2 * zeta * w * w * dt * dt * by_d;
  return result;
}

// Remembers the reading, its rate and the last force.
class FilterStep : public EffectStep {
 public:
  FilterStep(double w, double zeta) : w_(w), zeta_(zeta) {}
  std::size_t memory() const override { return 9; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> y(memory), rate(memory + 3), before(memory + 6);
    if (sample.first) {
      y = f;
      rate.setZero();
    } else if (sample.dt > 0) {
      const Vec3 rise = (f - before) / sample.dt, behind = 2 * zeta_ / w_ * rise;
      const Eigen::Matrix2d phi = fading(sample.dt, w_, zeta_, false).phi;
      const Vec3 off = y - before + behind, faster = rate - rise;
      y = f - behind + phi(0, 0) * off + phi(0, 1) * faster;
      rate = rise + phi(1, 0) * off + phi(1, 1) * faster;
    }
    before = f;
    f = y;
  }

 private:
  double w_, zeta_;
};

class Filter : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "filter",
        .stage = Stage::kSensor,
        .title = "the force sensor's readings went through a low-pass filter of second order",
        .equation =
            "d2y/dt2 + 2 zeta w dy/dt + w^2 (y - f_true) = 0, w = 2 pi f0, f = y: exact for forces "
            "that are straight between samples",
        .source =
            "second-order low pass: Butterworth (zeta = 0.707), Bessel (0.866), two equal "
            "poles (1)",
        .assumptions =
            "one filter for all axes; settled before each press; poles that are complex or equal, "
            "for with one that is much slower than the other it is of first order (sensor-lag, "
            "which is no special case of this one, and whose dead time can only imitate it)",
        .parameters = {{"f0", "Hz",
                        "natural frequency: where the reading lags by a quarter of a "
                        "period",
                        kOpen, 5, 1e-3, kOpen, 1, true},
                       {"zeta", "1", "damping", 0.7071, 0.7071, 0.05, 1, 0.1, false}},
        .needs_time = true,
        .screened = true,
        .signature =
            "late and rounded after each change of speed, not at once too soft as behind a lag of "
            "first order; below a damping of 0.7 it swings over",
        .confounders = {"sensor-lag", "viscoelastic", "damper"},
        .separated_by =
            "a fast press with a hold, sampled ten times within the filter's period; the data "
            "sheet",
        .kinds = {"history", "rate", "contact-time"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue &f0 = find_value(values, "f0"), &zeta = find_value(values, "zeta");
    if (press.t.empty() || f0.value >= kOpen) return;
    const double w = 2 * M_PI * f0.value, z = zeta.value;
    const Eigen::Index columns = signal.df.cols();
    const Eigen::VectorXd f = signal.f;
    const Eigen::MatrixXd df = signal.df;
    // Reading and rate of the three axes, and their derivatives.
    Eigen::Vector3d y = f.head<3>(), rate = Eigen::Vector3d::Zero();
    Eigen::MatrixXd dy = df.topRows(3), drate = Eigen::MatrixXd::Zero(3, columns);
    for (Eigen::Index i = 1; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const double dt =
          press.t[static_cast<std::size_t>(i)] - press.t[static_cast<std::size_t>(i) - 1];
      if (dt > 0) {
        const Eigen::Vector3d before = f.segment<3>(3 * i - 3), now = f.segment<3>(3 * i);
        const Fading s = fading(dt, w, z, columns > 0);
        const Eigen::Vector3d rise = (now - before) / dt, behind = 2 * z / w * rise;
        const Eigen::Vector3d off = y - before + behind, faster = rate - rise;
        if (columns > 0) {
          const Eigen::MatrixXd drise =
              (df.middleRows(3 * i, 3) - df.middleRows(3 * i - 3, 3)) / dt;
          Eigen::MatrixXd dbehind = 2 * z / w * drise;
          if (f0.column >= 0) dbehind.col(f0.column) -= 2 * M_PI / w * behind;
          if (zeta.column >= 0) dbehind.col(zeta.column) += 2 / w * rise;
          const Eigen::MatrixXd doff = dy - df.middleRows(3 * i - 3, 3) + dbehind;
          const Eigen::MatrixXd dfaster = drate - drise;
          dy = df.middleRows(3 * i, 3) - dbehind + s.phi(0, 0) * doff + s.phi(0, 1) * dfaster;
          drate = drise + s.phi(1, 0) * doff + s.phi(1, 1) * dfaster;
          add_own(s.dw, 2 * M_PI, f0.column, off, faster, dy, drate);
          add_own(s.dzeta, 1, zeta.column, off, faster, dy, drate);
        }
        y = now - behind + s.phi(0, 0) * off + s.phi(0, 1) * faster;
        rate = rise + s.phi(1, 0) * off + s.phi(1, 1) * faster;
      }
      signal.f.segment<3>(3 * i) = y;
      if (columns > 0) signal.df.middleRows(3 * i, 3) = dy;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double f0 = find_value(values, "f0").value;
    if (f0 >= kOpen) return nullptr;
    return std::make_unique<FilterStep>(2 * M_PI * f0, find_value(values, "zeta").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double rate = 1 / std::max(data.sample_step, 1e-3);
    return {{0.1 * rate, 0.7}, {0.02 * rate, 0.7}};
  }
  // From one that is too slow for a press to one that is over within a sample.
  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    if (data.press_duration > 0) limits[0].first = 0.1 / data.press_duration;
    if (data.sample_step > 0)
      limits[0].second = std::max(2 * limits[0].first, 2 / data.sample_step);
    return limits;
  }

 private:
  static void add_own(const Eigen::Matrix2d& dphi, double factor, int column,
                      const Eigen::Vector3d& off, const Eigen::Vector3d& faster,
                      Eigen::MatrixXd& dy, Eigen::MatrixXd& drate) {
    if (column < 0) return;
    dy.col(column) += factor * (dphi(0, 0) * off + dphi(0, 1) * faster);
    drate.col(column) += factor * (dphi(1, 0) * off + dphi(1, 1) * faster);
  }
};

}  // namespace

const Effect& filter_effect() {
  static const Filter effect;
  return effect;
}

}  // namespace hapsim
