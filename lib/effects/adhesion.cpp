// The body holds on to the tool.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// How far adhesion is at work in one sample, and the derivatives of that.
struct Hold {
  double m = 0, dm_dd = 0;  // how much of the leaving has been mobilised, 0 to 1
  Eigen::RowVectorXd dm;    // by the parameters, through the motion
};

// m after a way `step` of the height.
double mobilised(double m, double step, double d) {
  return std::clamp(m + step / d, 0.0, 1.0);
}

// Remembers whether it is touched, m, and the last height.
class AdhesionStep : public EffectStep {
 public:
  AdhesionStep(double F, double d, double a) : F_(F), d_(d), a_(a) {}
  std::size_t memory() const override { return 3; }
  double reach() const override { return F_ > 0 ? d_ : 0; }
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    double &touched = memory[0], &m = memory[1], &before = memory[2];
    const double h = sample.u.dot(normal_);
    if (sample.first || sample.in_air || h >= d_) touched = 0;
    if (touched == 0) {
      touched = !sample.in_air && h < 0 ? 1 : 0;
      m = 0;
    } else {
      m = mobilised(m, h - before, d_);
    }
    before = h;
    if (touched == 0) return;
    f -= F_ * (a_ + (1 - a_) * m) * (h > 0 ? 1 - h / d_ : 1) * normal_;
  }

 private:
  double F_, d_, a_;
  Vec3 normal_ = Vec3::UnitZ();
};

class Adhesion : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "adhesion",
        .stage = Stage::kContact,
        .title = "the body sticks to the tool and holds it back when it leaves",
        .equation =
            "f = f_before - F w n, w = (a + (1 - a) m) min(1, 1 - h/d): h = u.n the height over "
            "the surface, m grows from 0 to 1 over a retreat by d and falls back over an advance; "
            "from the first touch until h = d",
        .source =
            "adhesion hysteresis: Maugis, Contact, Adhesion and Rupture of Elastic Solids, ch. "
            "3-4; "
            "a constant force within a range after Dugdale",
        .assumptions =
            "one force and one range for all positions; along the normal; no growth with rate or "
            "time of contact; how the range is used up is taken for straight",
        .parameters = {{"F", "N", "force that holds the tool when it leaves", 0, 0.1, 0, 1e6, 0.1,
                        false},
                       {"d", "m", "range: retreat that mobilises it, height that ends it", 1e-4,
                        1e-4, 1e-6, 0.05, 1e-4, true},
                       {"a", "1", "share that acts on the way in as well", 0, 0.2, 0, 1, 0.3,
                        false}},
        .needs_return = true,
        .needs_rim = true,
        .one_tool = true,
        .form_error = 0.05,
        .signature = "too stiff while the tool leaves, down to a pull before it comes off",
        .confounders = {"viscoelastic", "softening", "backlash", "deadband", "slack"},
        .separated_by =
            "a slow retreat until the tool is clear of the body, and a hold half-way out",
        .kinds = {"depth", "phase"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& F = find_value(values, "F");
    const ParameterValue& d = find_value(values, "d");
    const ParameterValue& a = find_value(values, "a");
    const bool through = press.du.cols() > 0 && signal.df.cols() > 0;
    const Vec3& n = press.normal;
    bool touched = false;
    double before = 0;
    Eigen::RowVectorXd dh, dh_before;
    Hold hold;
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const double h = press.u[i].dot(n);
      if (through) dh = n.transpose() * press.du.middleRows(row, 3);
      if (press.in_air[i] || (touched && h >= d.value)) touched = false;
      if (!touched) {
        touched = !press.in_air[i] && h < 0;
        hold = {0, 0, Eigen::RowVectorXd::Zero(through ? dh.size() : 0)};
      } else {
        advance(h - before, d.value, dh, dh_before, hold);
      }
      before = h;
      dh_before = dh;
      if (!touched) continue;
      const double share = a.value + (1 - a.value) * hold.m;
      const double near = h > 0 ? 1 - h / d.value : 1;
      signal.f.segment<3>(row) -= F.value * share * near * n;
      if (signal.df.cols() == 0) continue;
      if (F.column >= 0) signal.df.block<3, 1>(row, F.column) -= share * near * n;
      if (a.column >= 0) signal.df.block<3, 1>(row, a.column) -= F.value * (1 - hold.m) * near * n;
      const double dnear_dd = h > 0 ? h / (d.value * d.value) : 0;
      if (d.column >= 0)
        signal.df.block<3, 1>(row, d.column) -=
            F.value * ((1 - a.value) * hold.dm_dd * near + share * dnear_dd) * n;
      if (!through) continue;
      const double dnear_dh = h > 0 ? -1 / d.value : 0;
      signal.df.middleRows(row, 3) -=
          F.value * n * ((1 - a.value) * near * hold.dm + share * dnear_dh * dh);
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<AdhesionStep>(find_value(values, "F").value,
                                          find_value(values, "d").value,
                                          find_value(values, "a").value);
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    const double F = 0.05 * data.peak_force;
    return {{F, 0.05 * data.depth, 0.05}, {F, 0.4 * data.depth, 0.05}, {F, 0.05 * data.depth, 0.9}};
  }

 private:
  static void advance(double step, double d, const Eigen::RowVectorXd& dh,
                      const Eigen::RowVectorXd& dh_before, Hold& hold) {
    const double m = hold.m + step / d;
    if (m <= 0 || m >= 1) {
      hold = {m <= 0 ? 0.0 : 1.0, 0, Eigen::RowVectorXd::Zero(dh.size())};
      return;
    }
    hold.m = m;
    hold.dm_dd -= step / (d * d);
    if (dh.size() > 0) hold.dm += (dh - dh_before) / d;
  }
};

}  // namespace

const Effect& adhesion_effect() {
  static const Adhesion effect;
  return effect;
}

}  // namespace hapsim
