// The tool slides when the tangential force exceeds what friction can carry.
#include <algorithm>

#include "effects/effect_step.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

constexpr double kRough = 1e3;  // a friction coefficient from which on nothing slips

// The tangential force of a trial one; g: what slip has taken from it so far.
struct Return {
  double along = 0, pressure = 0, length = 0, bound = 0;
  bool slips = false;
  Vec3 trial = Vec3::Zero(), tangential = Vec3::Zero();
};
Return radial_return(const Vec3& f, const Vec3& n, double mu, const Vec3& g) {
  Return r;
  r.along = f.dot(n);
  r.pressure = std::max(0.0, r.along);
  r.trial = (Eigen::Matrix3d::Identity() - n * n.transpose()) * f + g;
  r.length = r.trial.norm();
  r.bound = mu * r.pressure;
  r.slips = r.length > r.bound;
  r.tangential = r.slips ? Vec3(r.bound / r.length * r.trial) : r.trial;
  return r;
}

// Remembers g.
class FrictionStep : public EffectStep {
 public:
  explicit FrictionStep(double mu) : mu_(mu) {}
  std::size_t memory() const override { return 3; }
  void take_place(const StepPlace& place) noexcept override { normal_ = place.normal; }
  void apply(const StepSample& sample, double* memory, Vec3& f) noexcept override {
    Eigen::Map<Vec3> g(memory);
    if (sample.first || sample.in_air) g.setZero();
    if (sample.in_air) return;
    const Return r = radial_return(f, normal_, mu_, g);
    g = r.tangential - (f - r.along * normal_);
    f = r.along * normal_ + r.tangential;
  }

 private:
  double mu_;
  Vec3 normal_ = Vec3::UnitZ();
};

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
            "slips as a whole, little against its radius. At finite strain slip does change it: "
            "elements of a block that stiffens have 4 % less at a depth of 0.35 radii, 10 % less "
            "where it is pushed aside as well, more farther in, which hs-simulate --large-strain "
            "has and this law has not",
        .parameters = {{"mu", "1", "coefficient of friction; 1000: bonded", kRough, 0.5, 1e-3,
                        kRough, 0.5, true}},
        .needs_sideways = true,
        .signature = "too stiff sideways beyond some share of the normal force, with a set after",
        .confounders = {"sensor-gain", "anisotropic", "softening"},
        .separated_by = "sideways presses to and fro, at two normal forces",
        .kinds = {"direction", "phase"}};
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
      const auto [along, pressure, length, bound, slips, trial, tangential] =
          radial_return(signal.f.segment<3>(row), n, mu.value, g);
      g = tangential - across * signal.f.segment<3>(row);
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

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    const double mu = find_value(values, "mu").value;
    if (mu >= kRough) return nullptr;
    return std::make_unique<FrictionStep>(mu);
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
