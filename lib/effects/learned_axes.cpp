// Axes along which forces grow by laws of their own, each way, as learned.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/learned_curve.h"

namespace hapsim {
namespace {

constexpr std::size_t kAxisKnots = 4;
using AxisCurve = LearnedCurve<kAxisKnots>;
// In shares of the axis' largest force. The value at the first is 0: the modulus says how small
// forces grow.
constexpr AxisCurve kAxisCurve({0, 0.35, 0.7, 1});

// A curve of the five: x and y for either sign, z for both.
struct OneWay {
  int axis;
  const char* letter;
  const char* name;
};
constexpr std::array<OneWay, 5> kWays{{{0, "px", "x, force above 0"},
                                       {0, "nx", "x, force below 0"},
                                       {1, "py", "y, force above 0"},
                                       {1, "ny", "y, force below 0"},
                                       {2, "pz", "z"}}};
constexpr std::array<const char*, 3> kSpans{"sx", "sy", "sz"};

// Of the value at a knot among the effect's parameters.
constexpr std::size_t index_of(std::size_t way, std::size_t knot) {
  return way * (kAxisKnots - 1) + knot - 1;
}

class AxisGains {
 public:
  explicit AxisGains(const Values& values) {
    std::size_t at = 0;
    for (std::size_t w = 0; w < kWays.size(); ++w)
      for (std::size_t k = 1; k < kAxisKnots; ++k) p_[w][k] = values[at++].value;
    for (double& span : spans_) span = values[at++].value;
  }
  static std::size_t way_of(int axis, double f) {
    return axis == 2 ? 4 : 2 * static_cast<std::size_t>(axis) + (f < 0 ? 1 : 0);
  }
  // The logarithm of the gain of a force of that size, its slope by the size [1/N], and its
  // weights.
  double at(std::size_t way, double size, double& slope, AxisCurve::Weights& by) const noexcept {
    const double span = spans_[static_cast<std::size_t>(kWays[way].axis)];
    AxisCurve::Weights slopes;
    kAxisCurve.at(size / span, by, slopes);
    double sum = 0;
    slope = 0;
    for (std::size_t k = 0; k < kAxisKnots; ++k)
      sum += by[k] * p_[way][k], slope += slopes[k] * p_[way][k] / span;
    return sum;
  }
  double for_want_of_knots(std::size_t way, double share) const {
    return hapsim::for_want_of_knots(kAxisCurve, p_[way], share);
  }

 private:
  std::array<AxisCurve::Weights, kWays.size()> p_{};
  std::array<double, 3> spans_{};
};

class LearnedAxes : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-axes",
        .stage = Stage::kSensor,
        .title = "along each axis forces grow by a law of their own, one for either sign",
        .equation =
            "f = f_true exp(P(|f_true| / s)) on each axis, s its largest force; P the cubic spline "
            "through 0 at 0 and its values at 0.35, 0.7 and 1: px of x above 0, nx below, py and "
            "ny of y, pz of z",
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
        .signature = "an error that follows the force along an axis, everywhere alike",
        .confounders = {"sensor-curve", "friction", "sensor-gain", "motion-scale", "anisotropic"},
        .separated_by =
            "a calibration weight along each axis, both ways; the same sideways press on a body "
            "that is glued to the table"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const AxisGains gains(values);
    for (Eigen::Index row = 0; row < 3 * static_cast<Eigen::Index>(press.size()); ++row) {
      const int axis = static_cast<int>(row % 3);
      const double size = std::abs(signal.f[row]);
      const std::size_t way = AxisGains::way_of(axis, signal.f[row]);
      double slope = 0;
      AxisCurve::Weights by;
      const double times = std::exp(gains.at(way, size, slope, by));
      signal.f[row] *= times;
      if (signal.df.cols() == 0) continue;
      signal.df.row(row) *= times * (1 + size * slope);
      for (std::size_t k = 1; k < kAxisKnots; ++k)
        if (const int column = values[index_of(way, k)].column; column >= 0)
          signal.df(row, column) += by[k] * signal.f[row];
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step([gains = AxisGains(values)](const StepSample&, Vec3& f) {
      double slope = 0;
      AxisCurve::Weights by;
      for (int axis = 0; axis < 3; ++axis)
        f[axis] *=
            std::exp(gains.at(AxisGains::way_of(axis, f[axis]), std::abs(f[axis]), slope, by));
    });
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const AxisGains gains(values);
    std::vector<EffectCurve> curves;
    for (std::size_t way = 0; way < kWays.size(); ++way) {
      const double span = find_value(values, kSpans[kWays[way].axis]).value;
      EffectCurve curve{kWays[way].name, "force", "N", "gain", "1", {}};
      for (int i = 0; i < kPoints; ++i) {
        const double share = static_cast<double>(i) / (kPoints - 1);
        double slope = 0;
        AxisCurve::Weights by;
        const double y = std::exp(gains.at(way, share * span, slope, by));
        CurvePoint point{share * span, y,
                         Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
        for (std::size_t k = 1; k < kAxisKnots; ++k)
          point.by[static_cast<Eigen::Index>(index_of(way, k))] = y * by[k];
        point.form = y * gains.for_want_of_knots(way, share);
        curve.points.push_back(std::move(point));
      }
      curves.push_back(std::move(curve));
    }
    return curves;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    std::vector<double> start(card().parameters.size() - kSpans.size(), 0);
    for (int k = 0; k < 3; ++k) start.push_back(std::max(data.largest[k], 1e-6));
    return {start};
  }

 private:
  static std::vector<ParameterCard> parameters() {
    std::vector<ParameterCard> all;
    for (const OneWay& way : kWays)
      for (std::size_t k = 1; k < kAxisKnots; ++k)
        all.push_back({way.letter + std::to_string(k), "1",
                       std::string("logarithm of the gain at that knot, ") + way.name, 0, 0, -5, 5,
                       0.1, false});
    for (const char* span : kSpans)
      all.push_back({span, "N", "largest force of that axis, which the knots span", 1, 1, 1e-9, 1e9,
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
