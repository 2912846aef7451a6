// A force that grows with the depth by a law that nobody has named, as learned.
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/learned_curve.h"

namespace hapsim {
namespace {

constexpr std::size_t kDepthKnots = 8;
using DepthCurve = LearnedCurve<kDepthKnots>;
// In shares of `depth`. The value at the last one is 0: the modulus says the force there.
constexpr DepthCurve kDepthCurve({0.04, 0.12, 0.22, 0.34, 0.48, 0.64, 0.82, 1});

struct DepthFactor {
  double depth = 1;
  std::array<double, kDepthKnots> p{};

  explicit DepthFactor(const Values& values) : depth(find_value(values, "depth").value) {
    for (const ParameterValue& v : values)
      if (v.name.front() == 'p') p[static_cast<std::size_t>(v.name.back() - '1')] = v.value;
  }
  // The logarithm of the factor at a depth, its slope [1/m], and its weights.
  double at(double d, double& slope, DepthCurve::Weights& by) const noexcept {
    DepthCurve::Weights slopes;
    kDepthCurve.at(d / depth, by, slopes);
    double sum = 0;
    slope = 0;
    for (std::size_t k = 0; k < kDepthKnots; ++k)
      sum += by[k] * p[k], slope += slopes[k] * p[k] / depth;
    return sum;
  }
};

class LearnedDepthStep : public EffectStep {
 public:
  explicit LearnedDepthStep(const Values& values) : factor_(values) {}
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void apply(const StepSample& sample, double*, Vec3& f) noexcept override {
    if (sample.in_air) return;
    double slope = 0;
    DepthCurve::Weights by;
    f *= std::exp(factor_.at(-sample.u.dot(normal_), slope, by));
  }

 private:
  DepthFactor factor_;
  Vec3 normal_ = Vec3::UnitZ();
};

ParameterCard depth_value(int knot) {
  return {"p" + std::to_string(knot),
          "1",
          "logarithm of the factor at that knot",
          0,
          0,
          -5,
          5,
          0.1,
          false};
}

class LearnedDepth : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-depth",
        .stage = Stage::kContact,
        .title = "the force grows with the depth by a law of its own, the same everywhere",
        .equation =
            "f = f_before exp(P(d / depth)), P the cubic spline through p1 to p7 at 0.04, 0.12, "
            "0.22, 0.34, 0.48, 0.64, 0.82 and 0 at 1, straight before the first and level beyond "
            "the last; d the depth along the normal",
        .source =
            "regression splines (Hastie, Tibshirani and Friedman, The Elements of "
            "Statistical Learning, 5.2)",
        .assumptions =
            "no law is assumed but smoothness; the same at every place, in every direction and at "
            "any speed; says nothing of depths that were not pressed",
        .parameters = {depth_value(1),
                       depth_value(2),
                       depth_value(3),
                       depth_value(4),
                       depth_value(5),
                       depth_value(6),
                       depth_value(7),
                       {"depth", "m", "deepest depth that was learned from", 1e-3, 1e-3, 1e-9, 10,
                        1e-3, false, std::numeric_limits<double>::quiet_NaN(), true}},
        .form_error = 0.05,
        .learned = true,
        .signature = "an error that follows the depth at every place, by no law that is known",
        .confounders = {"hyperelastic", "tip", "layer", "sensor-curve", "touch"},
        .separated_by =
            "presses at other depths, a tool of another radius, and a calibration weight",
        .kinds = {"depth", "reading"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const DepthFactor factor(values);
    for (std::size_t i = 0; i < press.size(); ++i) {
      if (press.in_air[i]) continue;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      double slope = 0;
      DepthCurve::Weights by;
      const double times = std::exp(factor.at(-press.u[i].dot(press.normal), slope, by));
      signal.f.segment<3>(row) *= times;
      if (signal.df.cols() == 0) continue;
      const Vec3 f = signal.f.segment<3>(row);
      signal.df.middleRows(row, 3) *= times;
      if (press.du.cols() > 0)
        signal.df.middleRows(row, 3) -=
            slope * f * (press.normal.transpose() * press.du.middleRows(row, 3));
      for (const ParameterValue& v : values)
        if (v.column >= 0)
          signal.df.block<3, 1>(row, v.column) +=
              by[static_cast<std::size_t>(v.name.back() - '1')] * f;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<LearnedDepthStep>(values);
  }

  std::vector<EffectCurve> curves(const Values& values) const override {
    constexpr int kPoints = 41;
    const DepthFactor factor(values);
    EffectCurve curve{"", "depth", "m", "factor", "1", {}};
    for (int i = 0; i < kPoints; ++i) {
      const double d = factor.depth * i / (kPoints - 1);
      double slope = 0;
      DepthCurve::Weights by;
      const double y = std::exp(factor.at(d, slope, by));
      CurvePoint point{d, y, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(values.size()))};
      for (std::size_t k = 0; k + 1 < kDepthKnots; ++k)
        point.by[static_cast<Eigen::Index>(k)] = y * by[k];
      point.form = y * for_want_of_knots(kDepthCurve, factor.p, d / factor.depth);
      curve.points.push_back(std::move(point));
    }
    return {curve};
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0, 0, 0, 0, 0, 0, 0, data.depth}};
  }
};

}  // namespace

const Effect& learned_depth_effect() {
  static const LearnedDepth effect;
  return effect;
}

}  // namespace hapsim
