// A zero of the force sensor that wanders during the session, as learned.
#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/learned_curve.h"

namespace hapsim {
namespace {

constexpr std::size_t kZeroKnots = 6;
using ZeroCurve = LearnedCurve<kZeroKnots>;
constexpr ZeroCurve kZeroCurve({0, 0.2, 0.4, 0.6, 0.8, 1});  // in shares of `session`
constexpr const char* kZeroAxes = "xyz";

std::string zero_name(int axis, std::size_t knot) {
  return std::string("z") + kZeroAxes[axis] + std::to_string(knot + 1);
}

// The zero at a time of the session.
class WanderingZero {
 public:
  explicit WanderingZero(const Values& values) : session_(find_value(values, "session").value) {
    for (int k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < kZeroKnots; ++i)
        z_[i][k] = find_value(values, zero_name(k, i)).value;
  }
  Vec3 at(double t, ZeroCurve::Weights& by) const noexcept {
    ZeroCurve::Weights slopes;
    kZeroCurve.at(t / session_, by, slopes);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < kZeroKnots; ++i) sum += by[i] * z_[i];
    return sum;
  }

  double for_want_of_knots(double t, int axis) const {
    ZeroCurve::Weights y;
    for (std::size_t i = 0; i < kZeroKnots; ++i) y[i] = z_[i][axis];
    return hapsim::for_want_of_knots(kZeroCurve, y, t / session_);
  }

 private:
  double session_;
  std::array<Vec3, kZeroKnots> z_;
};

class LearnedDrift : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-drift",
        .stage = Stage::kSensor,
        .title = "the force sensor's zero wanders during the session",
        .equation =
            "f = f_true + Z(t / session), Z for each axis the cubic spline through its six "
            "values at 0, 0.2, 0.4, 0.6, 0.8 and 1, t from the start of the session",
        .source =
            "regression splines (Hastie, Tibshirani and Friedman, The Elements of "
            "Statistical Learning, 5.2)",
        .assumptions =
            "smooth over the session; acts in the air too; says nothing of another "
            "session",
        .parameters = parameters(),
        .needs_time = true,
        .needs_session = true,
        .among_presses = true,
        .form_error = 0.05,
        .learned = true,
        .signature = "an error that follows the time of the session, in the air as well",
        .confounders = {"sensor-drift", "tare", "temperature", "softening"},
        .separated_by = "samples in the air, and the first position pressed again at the end",
        .contains = {"sensor-drift", "sensor-settling", "sensor-bias"},
        .kinds = {"offset", "drift"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const WanderingZero zero(values);
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      ZeroCurve::Weights by;
      signal.f.segment<3>(row) += zero.at(press.session.empty() ? 0 : press.session[i], by);
      if (signal.df.cols() == 0) continue;
      for (int k = 0; k < 3; ++k)
        for (std::size_t q = 0; q < kZeroKnots; ++q) {
          const int column = values[static_cast<std::size_t>(k) * kZeroKnots + q].column;
          if (column >= 0) signal.df(row + k, column) += by[q];
        }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return map_step([zero = WanderingZero(values)](const StepSample& sample, Vec3& f) {
      ZeroCurve::Weights by;
      f += zero.at(sample.session, by);
    });
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const double session = find_value(values, "session").value;
    const WanderingZero zero(values);
    std::vector<EffectCurve> curves;
    for (int k = 0; k < 3; ++k) {
      EffectCurve curve{std::string(1, kZeroAxes[k]), "time", "s", "zero", "N", {}};
      for (int i = 0; i < kPoints; ++i) {
        const double t = session * i / (kPoints - 1);
        ZeroCurve::Weights by;
        CurvePoint point{t, zero.at(t, by)[k],
                         Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
        for (std::size_t q = 0; q < kZeroKnots; ++q)
          point.by[static_cast<Eigen::Index>(static_cast<std::size_t>(k) * kZeroKnots + q)] = by[q];
        point.form = zero.for_want_of_knots(t, k);
        curve.points.push_back(std::move(point));
      }
      curves.push_back(std::move(curve));
    }
    return curves;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    std::vector<double> start(3 * kZeroKnots, 0);
    start.push_back(std::max(data.session, 1e-3));
    return {start};
  }

 private:
  static std::vector<ParameterCard> parameters() {
    std::vector<ParameterCard> all;
    for (int k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < kZeroKnots; ++i)
        all.push_back({zero_name(k, i), "N",
                       std::string("zero along ") + kZeroAxes[k] + " at that knot", 0, 0, -1e6, 1e6,
                       0.1, false});
    all.push_back({"session", "s", "time that the knots span", 1, 1, 1e-3, 1e9, 1, false,
                   std::numeric_limits<double>::quiet_NaN(), true});
    return all;
  }
};

}  // namespace

const Effect& learned_drift_effect() {
  static const LearnedDrift effect;
  return effect;
}

}  // namespace hapsim
