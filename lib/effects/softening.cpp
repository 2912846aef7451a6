// Stress softening and ageing: the first press to a depth is stiffer than those after it, or each
// press is softer than those before.
#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/pressed_places.h"

namespace hapsim {
namespace {

// What is lost at depth q, over s.
struct Loss {
  double x = 0, power = 0, now = 0, fade = 0, before = 0, share = 0;
};
Loss loss(double q, double most, double past, double m, double c, double k) {
  Loss l;
  l.x = q / most;
  l.power = std::pow(l.x, m);
  l.now = 1 - l.power;
  l.fade = q > past && past > 0 ? std::log(past / q) : 0;
  l.before = past > 0 ? std::exp(k * l.fade) : 0;
  l.share = (1 - c) * l.before + c * l.now;
  return l;
}

// Remembers of this press its place, the deepest before it, the deepest so far and when it began;
// then the places and how deep each was pressed.
class SofteningStep : public EffectStep {
 public:
  SofteningStep(double s, double m, double c, double k, double rate, bool heals)
      : s_(s), m_(m), c_(c), k_(k), rate_(rate), heals_(heals) {}
  std::size_t memory() const override { return 4 + PressedPlaces::kMemory; }
  void take_place(const StepPlace& place) noexcept override {
    point_ = place.point;
    normal_ = place.normal;
  }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    double &here = memory[0], &past = memory[1], &most = memory[2], &fresh = memory[3];
    PressedPlaces places(memory + 4);
    if (sample.first) {
      here = places.find(point_);
      past = heals_ ? 0 : places.deepest(here);
      most = past;
      fresh = std::exp(-rate_ * sample.session);
    }
    f *= fresh;
    const double recorded = sample.recorded.norm();
    if (!sample.in_air && sample.recorded.dot(normal_) <= 0)
      places.deepest(here) = std::max(places.deepest(here), recorded);
    const double q = sample.u.norm();
    if (sample.in_air || q <= 0 || sample.u.dot(normal_) > 0) return;
    most = std::max(most, q);
    f *= 1 - s_ * loss(q, most, past, m_, c_, k_).share;
  }

 private:
  double s_, m_, c_, k_, rate_;
  bool heals_;
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
};

class Softening : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "softening",
        .stage = Stage::kBody,
        .title =
            "the material is softer where it was pressed before, or the longer the session lasts",
        .equation =
            "f = f_before (1 - s ((1 - c) min(1, (q_past/q)^k) + c (1 - (q/q_max)^m))) "
            "exp(-rate t), q the depth, q_past the deepest of earlier presses at this place, q_max "
            "the deepest so far, t from the start of the session to that of the press",
        .source =
            "Mullins effect in the manner of Ogden and Roxburgh, Proc. R. Soc. A 455 (1999), with "
            "the depth for the energy; ageing to first order of ln E in time",
        .assumptions =
            "no recovery between presses unless the metadata say 'recovery: full'; places do not "
            "soften each other; presses come in the order of the recording; what ages does so "
            "everywhere alike",
        .parameters = {{"s", "1", "share of the stiffness lost well below the deepest press", 0,
                        0.2, 0, 0.95, 0.2, false},
                       {"m", "1", "how sharply the loss sets in", 2, 2, 0.2, 30, 2, true},
                       {"c", "1",
                        "share that acts below the deepest point, at once: 1 Mullins effect, 0 all "
                        "presses after the first alike",
                        1, 0.9, 0, 1, 0.3, false},
                       {"k", "1",
                        "how fast the loss of later presses fades where they go deeper than those "
                        "before: 0 not at all",
                        2, 2, 0, 50, 1, false, std::numeric_limits<double>::quiet_NaN(), false,
                        true},
                       {"rate", "1/s",
                        "relative loss of stiffness per second of the session, whether pressed or "
                        "not (ageing; negative: it stiffens, as by drying)",
                        0, 0, -1, 1, 1e-5, false, std::numeric_limits<double>::quiet_NaN(), false,
                        true}},
        .needs_repeats = true,
        .one_tool = true,
        .signature =
            "too stiff in all presses after the first at a place, and on the way out; or more so "
            "from press to press",
        .confounders = {"viscoelastic", "temperature", "sensor-drift", "backlash", "adhesion"},
        .separated_by =
            "the same place pressed three times to one depth, then deeper, all at one speed; the "
            "first place pressed again at the end, and the temperature recorded",
        .kinds = {"cycle", "session-time"},
        .live = "it remembers the last 1,024 places: what was pressed before them is fresh again"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& s = find_value(values, "s");
    const ParameterValue& m = find_value(values, "m");
    const ParameterValue& c = find_value(values, "c");
    const ParameterValue& k = find_value(values, "k");
    const ParameterValue& rate = find_value(values, "rate");
    const double age = press.session.empty() ? 0 : press.session.front();
    const double fresh = std::exp(-rate.value * age);
    const bool through = press.du.cols() > 0 && signal.df.cols() > 0;
    const double past = press.past_depth;
    double most = past;
    Eigen::RowVectorXd dmost = Eigen::RowVectorXd::Zero(press.du.cols()), dq = dmost;
    signal.f *= fresh;
    signal.df *= fresh;
    if (rate.column >= 0 && signal.df.cols() > 0) signal.df.col(rate.column) -= age * signal.f;
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const double q = press.u[i].norm();
      if (press.in_air[i] || q <= 0 || press.u[i].dot(press.normal) > 0) continue;
      if (through) dq = press.u[i].transpose() / q * press.du.middleRows(row, 3);
      if (q >= most) {
        most = q;
        dmost = dq;
      }
      const auto [x, power, now, fade, before, share] =
          loss(q, most, past, m.value, c.value, k.value);
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      signal.f.segment<3>(row) *= 1 - s.value * share;
      if (signal.df.cols() == 0) continue;
      signal.df.middleRows(row, 3) *= 1 - s.value * share;
      if (s.column >= 0) signal.df.block<3, 1>(row, s.column) -= share * f;
      if (c.column >= 0) signal.df.block<3, 1>(row, c.column) -= s.value * (now - before) * f;
      if (k.column >= 0 && past > 0)
        signal.df.block<3, 1>(row, k.column) -= s.value * (1 - c.value) * before * fade * f;
      if (m.column >= 0)
        signal.df.block<3, 1>(row, m.column) += s.value * c.value * power * std::log(x) * f;
      if (!through) continue;
      Eigen::RowVectorXd dshare = -c.value * m.value * power / q * (dq - x * dmost);
      if (q > past) dshare -= (1 - c.value) * k.value * before / q * dq;
      signal.df.middleRows(row, 3) -= s.value * f * dshare;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    const auto value = [&](const char* name) { return find_value(values, name).value; };
    return std::make_unique<SofteningStep>(value("s"), value("m"), value("c"), value("k"),
                                           value("rate"), context.heals);
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{0.15, 1, 0.9, 2, 0},    {0.15, 6, 0.9, 2, 0},   {0.15, 6, 0.05, 2, 0},
            {0.15, 6, 0.05, 0.1, 0}, {0.15, 6, 0.05, 20, 0}, {0, 2, 0.5, 2, 0}};
  }
};

}  // namespace

const Effect& softening_effect() {
  static const Softening effect;
  return effect;
}

}  // namespace hapsim
