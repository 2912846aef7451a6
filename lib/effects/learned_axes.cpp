// Forces that grow by laws of their own along the z axis and across it, as learned.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/learned_curve.h"

namespace hapsim {
namespace {

constexpr std::size_t kAxisKnots = 8;
using AxisCurve = LearnedCurve<kAxisKnots>;
// In shares of the largest force of its kind. Along z the value at the last is 0: the modulus says
// the force there. At the first it would be said by forces too small to be measured.
constexpr AxisCurve kAxisCurve({0.04, 0.12, 0.22, 0.34, 0.48, 0.64, 0.82, 1});

// Force across the z axis, |(fx, fy)|, and along it, |fz|.
enum Way : std::size_t { kAcross, kAlong, kWays };
constexpr std::array<const char*, kWays> kLetters{"a", "z"}, kSpans{"sa", "sz"},
    kNames{"across z", "along z"};

constexpr std::size_t values_of(std::size_t way) {
  return way == kAcross ? kAxisKnots : kAxisKnots - 1;
}
// Of the value at a knot among the effect's parameters.
constexpr std::size_t index_of(std::size_t way, std::size_t knot) {
  return way == kAcross ? knot : values_of(kAcross) + knot;
}

class AxisGains {
 public:
  explicit AxisGains(const Values& values) {
    for (std::size_t way = 0; way < kWays; ++way) {
      for (std::size_t k = 0; k < values_of(way); ++k) p_[way][k] = values[index_of(way, k)].value;
      spans_[way] = find_value(values, kSpans[way]).value;
    }
  }

  // What a force of some size [N] is read as.
  struct Reading {
    double times = 1;         // over the force
    double power = 1;         // d log(reading) / d log(force)
    AxisCurve::Weights by{};  // of the gain's logarithm: of the values at the knots
  };
  // Solves log(reading) = log(size) + P(reading): Newton's steps, halved brackets where one leaves
  // them (Press et al., Numerical Recipes, 9.4).
  Reading of(std::size_t way, double size) const noexcept {
    constexpr double kFarthest = 5, kSteepest = 0.1, kExact = 1e-13;
    constexpr int kMost = 60;
    Reading r;
    if (!(size > 0)) return r;
    const double start = std::log(size);
    double low = start - kFarthest, high = start + kFarthest, v = start, power = 1;
    for (int i = 0; i < kMost; ++i) {
      double slope = 0;
      const double off = v - start - at(way, std::exp(v), slope, r.by);
      (off > 0 ? high : low) = v;
      power = 1 - slope * std::exp(v);
      const double next = power > kSteepest ? v - off / power : high + 1;
      if (std::abs(off) < kExact) break;
      v = next > low && next < high ? next : (low + high) / 2;
    }
    r.times = std::exp(v - start);
    r.power = 1 / std::max(power, kSteepest);
    return r;
  }

  // The logarithm of the gain at a reading, its slope by it [1/N], and its weights.
  double at(std::size_t way, double reading, double& slope, AxisCurve::Weights& by) const noexcept {
    AxisCurve::Weights slopes;
    kAxisCurve.at(reading / spans_[way], by, slopes);
    double sum = 0;
    slope = 0;
    for (std::size_t k = 0; k < kAxisKnots; ++k)
      sum += by[k] * p_[way][k], slope += slopes[k] * p_[way][k] / spans_[way];
    return sum;
  }
  double for_want_of_knots(std::size_t way, double share) const {
    return hapsim::for_want_of_knots(kAxisCurve, p_[way], share);
  }

 private:
  std::array<AxisCurve::Weights, kWays> p_{};
  std::array<double, kWays> spans_{};
};

class LearnedAxes : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-axes",
        .stage = Stage::kSensor,
        .title = "forces grow by laws of their own along z and across it, everywhere alike",
        .equation =
            "(fx, fy) = (fx, fy)_true exp(P(|(fx, fy)| / sa)), fz = fz_true exp(Q(|fz| / sz)), P "
            "and Q cubic splines over what is read, at 0.04, 0.12, 0.22, 0.34, 0.48, 0.64, 0.82 "
            "and 1 through a1 to a8, and through z1 to z7 and 0, straight before the first and "
            "level beyond the last; z is that of the recording",
        .source =
            "regression splines (Hastie, Tibshirani and Friedman, The Elements of "
            "Statistical Learning, 5.2)",
        .assumptions =
            "the same at every place, at any speed and time; whether the sensor, the support or "
            "the contact gives way is not said; says nothing of larger forces",
        .parameters = parameters(),
        .needs_sideways = true,
        .form_error = 0.05,
        .learned = true,
        .signature = "an error that follows the force across z, or along it, everywhere alike",
        .confounders = {"sensor-curve", "friction", "sensor-gain", "motion-scale", "anisotropic"},
        .separated_by =
            "a calibration weight along each axis, both ways; the same sideways press on a body "
            "that is glued to the table",
        // Of the reading: along z it is a curve of what that axis reads, as of a sensor that bends.
        .kinds = {"direction", "set-up", "reading"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const AxisGains gains(values);
    for (Eigen::Index row = 0; row < 3 * static_cast<Eigen::Index>(press.size()); row += 3) {
      take(gains, kAcross, values, signal, row, 2);
      take(gains, kAlong, values, signal, row + 2, 1);
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step([gains = AxisGains(values)](const StepSample&, Vec3& f) {
      f.head<2>() *= gains.of(kAcross, f.head<2>().norm()).times;
      f.z() *= gains.of(kAlong, std::abs(f.z())).times;
    });
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const AxisGains gains(values);
    std::vector<EffectCurve> curves;
    for (std::size_t way = 0; way < kWays; ++way) {
      const double span = find_value(values, kSpans[way]).value;
      EffectCurve curve{kNames[way], "force", "N", "gain", "1", {}};
      for (int i = 0; i < kPoints; ++i) {
        const double share = static_cast<double>(i) / (kPoints - 1);
        double slope = 0;
        AxisCurve::Weights by;
        const double y = std::exp(gains.at(way, share * span, slope, by));
        CurvePoint point{share * span, y,
                         Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
        for (std::size_t k = 0; k < values_of(way); ++k)
          point.by[static_cast<Eigen::Index>(index_of(way, k))] = y * by[k];
        point.form = y * gains.for_want_of_knots(way, share);
        curve.points.push_back(std::move(point));
      }
      curves.push_back(std::move(curve));
    }
    return curves;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    std::vector<double> start(index_of(kAlong, values_of(kAlong)), 0);
    start.push_back(std::max(data.peak_across, 1e-9));
    start.push_back(std::max(data.peak_along, 1e-9));
    return {start};
  }

 private:
  // The gain of the `count` components from `row` on, whose size it goes by.
  static void take(const AxisGains& gains, Way way, const Values& values, Signal& signal,
                   Eigen::Index row, Eigen::Index count) {
    const Eigen::VectorXd f = signal.f.segment(row, count);
    const double size = f.norm();
    const AxisGains::Reading r = gains.of(way, size);
    signal.f.segment(row, count) *= r.times;
    if (signal.df.cols() == 0) return;
    // Of the reading y of x: d log y = (d log x + dP at y) / (1 - y P').
    Eigen::MatrixXd df = signal.df.middleRows(row, count);
    if (size > 0) df += (r.power - 1) / (size * size) * f * (f.transpose() * df).eval();
    signal.df.middleRows(row, count) = r.times * df;
    for (std::size_t k = 0; k < values_of(way); ++k)
      if (const int column = values[index_of(way, k)].column; column >= 0)
        signal.df.block(row, column, count, 1) += r.power * r.by[k] * signal.f.segment(row, count);
  }

  static std::vector<ParameterCard> parameters() {
    std::vector<ParameterCard> all;
    for (std::size_t way = 0; way < kWays; ++way)
      for (std::size_t k = 0; k < values_of(way); ++k)
        all.push_back({kLetters[way] + std::to_string(k + 1), "1",
                       std::string("logarithm of the gain at that knot, ") + kNames[way], 0, 0, -2,
                       2, 0.1, false});
    for (std::size_t way = 0; way < kWays; ++way)
      all.push_back({kSpans[way], "N", std::string("largest force ") + kNames[way], 1, 1, 1e-9, 1e9,
                     1, false, std::numeric_limits<double>::quiet_NaN(), true});
    return all;
  }
};

}  // namespace

const Effect& learned_axes_effect() {
  static const LearnedAxes effect;
  return effect;
}

}  // namespace hapsim
