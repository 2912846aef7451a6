// A surface that does not come all the way back.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/pressed_places.h"

namespace hapsim {
namespace {

// What is left of a displacement u of size q where `set` of the way is permanent: nothing until the
// tool has come that far.
double left_of(double q, double set) {
  return q > set ? 1 - set / q : 0;
}

// Remembers of this press its place and the deepest so far; then the places.
class PlasticStep : public EffectStep {
 public:
  PlasticStep(double p, double y, bool heals) : p_(p), y_(y), heals_(heals) {}
  std::size_t memory() const override { return 2 + PressedPlaces::kMemory; }
  void take_place(const StepPlace& place) noexcept override {
    point_ = place.point;
    normal_ = place.normal;
  }
  void move(StepSample& sample, double* memory) noexcept override {
    double &here = memory[0], &most = memory[1];
    PressedPlaces places(memory + 2);
    if (sample.first) {
      here = places.find(point_);
      most = heals_ ? 0 : places.deepest(here);
    }
    if (!sample.in_air && sample.recorded.dot(normal_) <= 0)
      places.deepest(here) = std::max(places.deepest(here), sample.recorded.norm());
    const double q = sample.u.norm();
    if (sample.in_air || q <= 0 || sample.u.dot(normal_) > 0) return;
    most = std::max(most, q);
    sample.u *= left_of(q, p_ * std::max(0.0, most - y_));
  }

 private:
  double p_, y_;
  bool heals_;
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
};

class Plastic : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "plastic",
        .stage = Stage::kMotion,
        .title = "a part of what was pressed in stays",
        .equation =
            "u' = u max(0, 1 - s/|u|), s = p max(0, q_max - y), q_max the deepest |u| so far at "
            "this place, of earlier presses too",
        .source =
            "bilinear elastic and plastic contact: Walton and Braun, J. Rheol. 30, 1986; Thornton, "
            "J. Appl. Mech. 64, 1997",
        .assumptions =
            "the set does not recover, unless the metadata say 'recovery: full' between presses; "
            "it is the same share at every place; places do not set each other; what has set is as "
            "stiff as before",
        .parameters = {{"p", "1", "share of the depth beyond y that stays", 0, 0.2, 0, 0.95, 0.1,
                        false},
                       {"y", "m", "depth from which on something stays", 0, 0, 0, 0.1, 1e-3,
                        false}},
        .needs_return = true,
        .one_tool = true,
        .screened = true,
        .signature =
            "too stiff on the way out, where the force ends before the tool is back; a press at "
            "the same place begins later",
        .confounders = {"softening", "touch", "backlash", "viscoelastic"},
        .separated_by =
            "the same place pressed three times to one depth, then deeper, each with a slow way "
            "out and a pause: what is soft comes back, what has set begins later",
        .kinds = {"cycle", "offset", "depth"},
        .live = "it remembers the last 1,024 places: what was pressed before them is fresh again"};
    return card;
  }

  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const ParameterValue& p = find_value(values, "p");
    const ParameterValue& y = find_value(values, "y");
    const bool derivatives = p.column >= 0 || y.column >= 0 || motion.du.cols() > 0;
    if (derivatives && motion.columns > 0) motion.make_du();
    const Eigen::Index columns = motion.du.cols();
    double most = press.past_depth;
    Eigen::RowVectorXd dmost = Eigen::RowVectorXd::Zero(columns), dq = dmost;
    for (std::size_t i = 0; i < motion.u.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const Vec3 u = motion.u[i];
      const double q = u.norm();
      if (press.in_air[i] || q <= 0 || u.dot(press.normal) > 0) continue;
      if (columns > 0) dq = u.transpose() / q * motion.du.middleRows(row, 3);
      if (q >= most) {
        most = q;
        dmost = dq;
      }
      const double beyond = std::max(0.0, most - y.value), set = p.value * beyond;
      const double left = left_of(q, set);
      motion.u[i] *= left;
      if (columns == 0) continue;
      motion.du.middleRows(row, 3) *= left;
      if (left <= 0) continue;
      Eigen::RowVectorXd dset = Eigen::RowVectorXd::Zero(columns);
      if (beyond > 0) {
        dset = p.value * dmost;
        if (p.column >= 0) dset[p.column] += beyond;
        if (y.column >= 0) dset[y.column] -= p.value;
      }
      motion.du.middleRows(row, 3) += u * (set / (q * q) * dq - dset / q);
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    return std::make_unique<PlasticStep>(find_value(values, "p").value,
                                         find_value(values, "y").value, context.heals);
  }

  std::vector<std::pair<double, double>> limits(const DataSummary& data) const override {
    auto limits = Effect::limits(data);
    limits[1].second = std::max(1e-6, 0.8 * data.depth);
    return limits;
  }

  std::vector<std::vector<double>> starts(const DataSummary& data, int) const override {
    return {{0.15, 0.05 * data.depth}, {0.15, 0.4 * data.depth}};
  }
};

}  // namespace

const Effect& plastic_effect() {
  static const Plastic effect;
  return effect;
}

}  // namespace hapsim
