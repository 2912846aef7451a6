// Stress softening and ageing: the first press to a depth is stiffer than those after it, or each
// press is softer than those before.
#include <cmath>
#include <limits>

#include "effects/effects.h"

namespace hapsim {
namespace {

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
            "first place pressed again at the end, and the temperature recorded"};
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
      const double x = q / most, power = std::pow(x, m.value), now = 1 - power;
      const double fade = q > past && past > 0 ? std::log(past / q) : 0;
      const double before = past > 0 ? std::exp(k.value * fade) : 0;
      const double share = (1 - c.value) * before + c.value * now;
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
