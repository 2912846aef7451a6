// A stiffness, or a gain of the sensor, that wanders during the session, as learned.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/learned_curve.h"

namespace hapsim {
namespace {

constexpr std::size_t kGainKnots = 6;
using GainCurve = LearnedCurve<kGainKnots>;
// In shares of `session`. The value at the first is 0: the modulus says the force there.
constexpr GainCurve kGainCurve({0, 0.2, 0.4, 0.6, 0.8, 1});

struct WanderingGain {
  double session = 1;
  std::array<double, kGainKnots> p{};

  explicit WanderingGain(const Values& values) : session(find_value(values, "session").value) {
    for (std::size_t k = 1; k < kGainKnots; ++k) p[k] = find_value(values, name_of(k)).value;
  }
  static std::string name_of(std::size_t knot) { return "p" + std::to_string(knot); }
  // The logarithm of the gain at a time of the session, and its weights.
  double at(double t, GainCurve::Weights& by) const noexcept {
    GainCurve::Weights slopes;
    kGainCurve.at(t / session, by, slopes);
    double sum = 0;
    for (std::size_t k = 0; k < kGainKnots; ++k) sum += by[k] * p[k];
    return sum;
  }
};

class LearnedGain : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-gain",
        .stage = Stage::kSensor,
        .title = "all forces grow or shrink during the session, by a law of its own",
        .equation =
            "f = f_true exp(P(t / session)), P the cubic spline through 0 at 0 and p1 to p5 at "
            "0.2, 0.4, 0.6, 0.8 and 1, t from the start of the session",
        .source =
            "regression splines (Hastie, Tibshirani and Friedman, The Elements of "
            "Statistical Learning, 5.2)",
        .assumptions =
            "smooth over the session, the same in all directions and at every place; whether the "
            "body or the sensor changes is not said; says nothing of another session",
        .parameters = parameters(),
        .needs_time = true,
        .needs_session = true,
        .among_presses = true,
        .form_error = 0.05,
        .learned = true,
        .signature = "forces that are too large or too small by a share that follows the session",
        .confounders = {"softening", "temperature", "sensor-gain", "learned-drift", "tare"},
        .separated_by =
            "the first position pressed again several times through the session, and the "
            "temperature recorded",
        .kinds = {"session-time", "cycle", "press"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    if (press.session.empty()) return;
    const WanderingGain gain(values);
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      GainCurve::Weights by;
      const double times = std::exp(gain.at(press.session[i], by));
      signal.f.segment<3>(row) *= times;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) *= times;
      const Vec3 f = signal.f.segment<3>(row);
      for (std::size_t k = 1; k < kGainKnots; ++k)
        if (const int column = values[k - 1].column; column >= 0)
          signal.df.block<3, 1>(row, column) += by[k] * f;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step([gain = WanderingGain(values)](const StepSample& sample, Vec3& f) {
      GainCurve::Weights by;
      f *= std::exp(gain.at(sample.session, by));
    });
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const WanderingGain gain(values);
    EffectCurve curve{"", "time", "s", "gain", "1", {}};
    for (int i = 0; i < kPoints; ++i) {
      const double t = gain.session * i / (kPoints - 1);
      GainCurve::Weights by;
      const double y = std::exp(gain.at(t, by));
      CurvePoint point{t, y, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
      for (std::size_t k = 1; k < kGainKnots; ++k)
        point.by[static_cast<Eigen::Index>(k - 1)] = y * by[k];
      point.form = y * for_want_of_knots(kGainCurve, gain.p, t / gain.session);
      curve.points.push_back(std::move(point));
    }
    return {curve};
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    std::vector<double> start(kGainKnots - 1, 0);
    start.push_back(std::max(data.session, 1e-3));
    return {start};
  }

 private:
  static std::vector<ParameterCard> parameters() {
    std::vector<ParameterCard> all;
    for (std::size_t k = 1; k < kGainKnots; ++k)
      all.push_back({WanderingGain::name_of(k), "1", "logarithm of the gain at that knot", 0, 0, -5,
                     5, 0.1, false});
    all.push_back({"session", "s", "time that the knots span", 1, 1, 1e-3, 1e9, 1, false,
                   std::numeric_limits<double>::quiet_NaN(), true});
    return all;
  }
};

}  // namespace

const Effect& learned_gain_effect() {
  static const LearnedGain effect;
  return effect;
}

}  // namespace hapsim
