// The tool slides when the tangential force exceeds what friction can carry.
#include <algorithm>

#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kRough = 1e3;  // a friction coefficient from which on nothing slips

class Friction : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "friction",
        .stage = Stage::kContact,
        .title = "the tool slips sideways",
        .equation =
            "|f_t| <= mu f_n; trial f_t = f_t,before + g, returned radially to the bound; "
            "g = k_t x slip, kept while the tool sticks",
        .source =
            "Coulomb's law by radial return: Simo and Hughes, Computational Inelasticity, 2.3",
        .assumptions =
            "the contact's tangential stiffness is the same in all tangential directions, and slip "
            "does not change the normal force: then the return needs no stiffness at all; the tool "
            "slips as a whole, little against its radius",
        .parameters = {{"mu", "1", "coefficient of friction; 1000: bonded", kRough, 0.5, 1e-3,
                        kRough, 0.5, true}},
        .needs_sideways = true,
        .signature = "too stiff sideways beyond some share of the normal force, with a set after",
        .confounders = {"sensor-gain", "anisotropic", "softening"},
        .separated_by = "sideways presses to and fro, at two normal forces"};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& mu = find_value(values, "mu");
    if (mu.value >= kRough) return;
    const Vec3& n = press.normal;
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();
    const Eigen::Index columns = signal.df.cols();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    Eigen::MatrixXd dg = Eigen::MatrixXd::Zero(3, columns);
    for (std::size_t i = 0; i < press.size(); ++i) {
      if (press.in_air[i]) {
        g.setZero();
        dg.setZero();
        continue;
      }
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Eigen::Vector3d f = signal.f.segment<3>(row);
      const double along = f.dot(n);
      const double pressure = std::max(0.0, along);
      const Eigen::Vector3d trial = across * f + g;
      const double length = trial.norm(), bound = mu.value * pressure;
      const bool slips = length > bound;
      const Eigen::Vector3d tangential = slips ? Eigen::Vector3d(bound / length * trial) : trial;
      g = tangential - across * f;
      signal.f.segment<3>(row) = along * n + tangential;
      if (columns == 0) continue;
      const Eigen::MatrixXd df = signal.df.middleRows(row, 3);
      Eigen::MatrixXd dt = across * df + dg;
      if (slips) {
        const Eigen::Vector3d t = trial / length;
        dt = (bound / length * (dt - t * (t.transpose() * dt))).eval();
        if (pressure > 0) dt += mu.value * t * (n.transpose() * df);
        if (mu.column >= 0) dt.col(mu.column) += pressure * t;
      }
      dg = dt - across * df;
      signal.df.middleRows(row, 3) = n * (n.transpose() * df) + dt;
    }
  }

  bool full(const Values& values, double, FullSpec& spec) const override {
    const double mu = find_value(values, "mu").value;
    if (mu < kRough) spec.friction = mu;
    return true;
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{0.15}, {0.3}, {0.6}};
  }
};

}  // namespace

const Effect& friction_effect() {
  static const Friction effect;
  return effect;
}

}  // namespace hapsim
