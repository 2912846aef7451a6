// A tool with a spherical tip: the contact grows with the depth until the whole tool is in contact.
#include <algorithm>

#include "effects/effects.h"
#include "effects/local_contact.h"
#include "effects/tip_law.h"
#include "effects/tip_step.h"

namespace hapsim {
namespace tip {
namespace {

// A ring with its derivatives by the columns.
struct Level : Ring {
  Eigen::RowVectorXd dz;
  Eigen::MatrixXd dside, dforce;
};

// The ring at the border of a contact that leaves, with its derivatives at fixed z.
Level border_level(const std::vector<Level>& path, const Tangential& t) {
  const Level &low = path[t.segment], &high = path[t.segment + 1];
  Level border{t.touched, {}, {}, {}};
  const Eigen::RowVectorXd dshare =
      -((1 - t.share) * low.dz + t.share * high.dz) / (high.z - low.z);
  border.dside = (1 - t.share) * low.dside + t.share * high.dside + (high.side - low.side) * dshare;
  border.dforce = low.dforce + t.mean.value * (border.dside - low.dside) +
                  (border.side - low.side) * (t.mean.by_low * low.dz);
  return border;
}

class Tip : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "tip",
        .stage = Stage::kContact,
        .title = "the tool's tip is spherical, so the contact grows with depth",
        .equation =
            "contact radius c = min(sqrt(z/kappa), a) at depth z under the tool; dF_n = k_n(c) dz, "
            "dF_t = k_t(c) dx_t on the way in, k(c) = k(a) c/a of a disc on a half-space; each "
            "ring lets go of its share of F_t when it parts; the rest of the body in series, "
            "1/k(c) + C",
        .source =
            "incremental contact: Mossakowski, J. Appl. Math. Mech. 27, 1963; Jaeger, Arch. Appl. "
            "Mech. 65, 1995; rings without slip: Popov and Hess, Method of Dimensionality "
            "Reduction in Contact Mechanics and Friction, 2015, ch. 3 and 5",
        .assumptions =
            "a paraboloid, bonded where it touches; contact radius small against the body; "
            "the contact carries no pull; flat again once the cap is whole in contact; the depth "
            "counts from the recorded contact point",
        .parameters = {{"kappa", "1/m", "curvature of the tip, 1/radius; 0: flat", 0, 100, 0, 1e4,
                        50, false}},
        .needs_rim = true,
        .one_tool = true,
        .signature = "too stiff at small depth, with forces that grow like depth^1.5 there",
        .confounders = {"hyperelastic", "sensor-curve", "slack", "deadband"},
        .separated_by =
            "presses deeper than the tip's cap is high, or with a flat tool, and a calibration "
            "weight on the sensor",
        .contains = {"slack"},
        .kinds = {"depth"},
        .live = "of a way in of more than 4,096 samples it remembers every second, or fewer"};
    return card;
  }

  // As a motion: the way of a flat tool that exerts the same force, so what the material does with
  // its forces in time comes after it (Lee and Radok, J. Appl. Mech. 27, 1960).
  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const ParameterValue& kappa = find_value(values, "kappa");
    if (kappa.value <= 0) return;
    const bool derivatives = motion.columns > 0;
    motion.make_du();
    const LocalContact contact(press.contact, press.normal, press.radius);
    const LocalContact::DiscByColumns disc = contact.disc_by_columns(motion.columns);
    std::vector<Level> path;  // empty: no contact
    Vec3 before = Vec3::Zero();
    Eigen::MatrixXd dbefore = Eigen::MatrixXd::Zero(3, motion.columns), du(3, motion.columns);
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Vec3 u = motion.u[i];
      if (derivatives) du = motion.du.middleRows(row, 3);
      if (press.in_air[i] || u.dot(press.normal) >= 0) {
        path.clear();
        motion.u[i].setZero();
        if (derivatives) motion.du.middleRows(row, 3).setZero();
      } else {
        if (path.empty()) path.push_back(touch_level(press.normal, before, u, dbefore, du));
        step(press, kappa, contact, disc, du, path, motion.u[i], derivatives ? &motion.du : nullptr,
             row);
      }
      before = u;
      dbefore = du;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    const double kappa = find_value(values, "kappa").value;
    if (kappa <= 0) return nullptr;
    return make_step(kappa, context.tool_radius);
  }

  bool full(const Values& values, double, FullSpec& spec) const override {
    spec.curvature = find_value(values, "kappa").value;
    return true;
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{20}, {100}, {400}};
  }
  std::vector<double> known(const DataSummary& data) const override {
    if (data.ball_radius <= 0) return {};
    return {1 / data.ball_radius};
  }

 private:
  // Where the straight way from the last place in the air crosses the surface.
  static Level touch_level(const Vec3& n, const Vec3& before, const Vec3& u,
                           const Eigen::MatrixXd& dbefore, const Eigen::MatrixXd& du) {
    const FirstTouch touch = first_touch(n, before, u);
    Level level;
    level.side = touch.side;
    if (du.cols() == 0) return level;
    Eigen::RowVectorXd dabove = n.transpose() * dbefore;
    if (touch.above == 0) dabove.setZero();
    const Eigen::RowVectorXd dshare =
        ((1 - touch.share) * dabove + touch.share * (n.transpose() * du)) / touch.all;
    const Eigen::MatrixXd dplace = dbefore + touch.share * (du - dbefore) + (u - before) * dshare;
    level.dside = dplace - n * (n.transpose() * dplace);
    level.dz = Eigen::RowVectorXd::Zero(du.cols());
    level.dforce = Eigen::MatrixXd::Zero(3, du.cols());
    return level;
  }

  // Finds the local way at u, goes on with `path`, and replaces u by the flat tool's way.
  static void step(const PressView& press, const ParameterValue& kappa, const LocalContact& contact,
                   const LocalContact::DiscByColumns& disc, const Eigen::MatrixXd& du,
                   std::vector<Level>& path, Vec3& u, Eigen::MatrixXd* motion_du,
                   Eigen::Index row) {
    const Vec3& n = press.normal;
    const double a = press.radius, k_n = contact.disc().normal, k_t = contact.disc().tangential;
    const TipLaw<std::vector<Level>> law{path, contact, n, kappa.value, a};
    const Eigen::Matrix3d& across = law.across;
    const Vec3 tool = u;
    Vec3 x = tool;
    const LocalForce force = contact.solve(law, tool, x);
    u = tool - x + contact.disc_way(force.F);

    const double z = std::max(0.0, -x.dot(n));
    const bool derivatives = motion_du != nullptr;
    const Tangential t = tangential(path, z, across * x, kappa.value, a);
    Level here{{z, across * x, t.value}, {}, {}, {}}, border{t.touched, {}, {}, {}};
    if (derivatives) {
      if (t.leaving) border = border_level(path, t);
      const Growth g = growth(z, kappa.value, a);
      Eigen::MatrixXd dt;  // of the tangential force over k_t, at fixed x
      if (t.leaving) {
        dt = border.dforce - g.beta * border.dside;
      } else {
        const Level& last = path.back();
        const MeanGrowth mean = mean_growth(last.z, z, kappa.value, a);
        dt = last.dforce - mean.value * last.dside +
             (here.side - last.side) * (mean.by_low * last.dz);
      }
      if (kappa.column >= 0) dt.col(kappa.column) += by_kappa(path, t, here, kappa.value, a);
      Eigen::MatrixXd dF = k_t * dt;
      dF.noalias() += t.value * disc.tangential;
      dF.noalias() -= g.integral * n * disc.normal;
      if (kappa.column >= 0) dF.col(kappa.column) -= k_n * g.integral_by_kappa * n;
      const LocalContact::Derivatives d = contact.derivatives(force, tool, x, du, dF, disc);
      motion_du->middleRows(row, 3) = du - d.dx + contact.disc_way_derivative(force.F, d.dF, disc);
      here.dz = -n.transpose() * d.dx;
      here.dside = across * d.dx;
      here.dforce = dt + t.by_z * here.dz + t.by_side * here.dside;
      if (t.leaving) {  // the border moved with z
        if (kappa.column >= 0)
          border.dforce.col(kappa.column) += border_by_kappa(path, t, kappa.value, a);
        const Level &low = path[t.segment], &high = path[t.segment + 1];
        const Vec3 slope = (high.side - low.side) / (high.z - low.z);
        border.dz = here.dz;
        border.dside += slope * here.dz;
        border.dforce += g.beta * slope * here.dz;
      }
    }
    if (t.leaving) {
      while (path.size() > 1 && path.back().z > z) path.pop_back();
      path.push_back(border);
    }
    path.push_back(here);
  }

  static Vec3 border_by_kappa(const std::vector<Level>& path, const Tangential& t, double kappa,
                              double a) {
    const Level& low = path[t.segment];
    return mean_growth(low.z, t.touched.z, kappa, a).by_kappa * (t.touched.side - low.side);
  }

  static Vec3 by_kappa(const std::vector<Level>& path, const Tangential& t, const Level& here,
                       double kappa, double a) {
    if (t.leaving)
      return border_by_kappa(path, t, kappa, a) +
             growth(here.z, kappa, a).by_kappa * (here.side - t.touched.side);
    const Level& last = path.back();
    return mean_growth(last.z, here.z, kappa, a).by_kappa * (here.side - last.side);
  }
};

}  // namespace
}  // namespace tip

const Effect& tip_effect() {
  static const tip::Tip effect;
  return effect;
}

}  // namespace hapsim
