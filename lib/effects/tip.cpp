// A tool with a spherical tip: the contact grows with the depth until the whole tool is in contact.
#include <algorithm>
#include <cmath>

#include "effects/effects.h"
#include "effects/local_contact.h"

namespace hapsim {
namespace {

// Contact radius over the tool's, beta = min(1, sqrt(z/kappa)/a), at depth z; its integral from 0,
// which is the mean stiffness times z; and the derivatives of both.
struct Growth {
  double beta = 0, by_z = 0, by_kappa = 0;
  double integral = 0, integral_by_kappa = 0;
};

Growth growth(double z, double kappa, double a) {
  Growth g;
  if (z <= 0) return g;
  const double full = kappa * a * a;
  if (z >= full) {
    g.beta = 1;
    g.integral = z - full / 3;
    g.integral_by_kappa = -a * a / 3;
    return g;
  }
  g.beta = std::sqrt(z / full);
  g.by_z = g.beta / (2 * z);
  g.by_kappa = -g.beta / (2 * kappa);
  g.integral = 2 * z * g.beta / 3;
  g.integral_by_kappa = -g.integral / (2 * kappa);
  return g;
}

// Mean of beta between two depths, and its derivatives.
struct MeanGrowth {
  double value = 0, by_low = 0, by_high = 0, by_kappa = 0;
};

MeanGrowth mean_growth(double low, double high, double kappa, double a) {
  const double step = high - low;
  MeanGrowth mean;
  if (step <= 1e-7 * high) {  // the difference would cancel; the middle errs by the step squared
    const Growth middle = growth((low + high) / 2, kappa, a);
    mean.value = middle.beta;
    mean.by_low = mean.by_high = middle.by_z / 2;
    mean.by_kappa = middle.by_kappa;
    return mean;
  }
  const Growth l = growth(low, kappa, a), h = growth(high, kappa, a);
  mean.value = (h.integral - l.integral) / step;
  mean.by_high = (h.beta - mean.value) / step;
  mean.by_low = (mean.value - l.beta) / step;
  mean.by_kappa = (h.integral_by_kappa - l.integral_by_kappa) / step;
  return mean;
}

// A point of the way in: the ring of the tip that touches at depth z did so at the sideways place
// `side`, when the tangential force over k_t was `force`; and the derivatives by the columns.
struct Level {
  double z = 0;
  Vec3 side = Vec3::Zero(), force = Vec3::Zero();
  Eigen::RowVectorXd dz;
  Eigen::MatrixXd dside, dforce;
};

// Tangential force over k_t at depth z and sideways place `side`.
struct Tangential {
  Vec3 value = Vec3::Zero(), by_z = Vec3::Zero();
  double by_side = 0;
  Level touched;  // of the ring at the contact's border
  bool leaving = false;
};

// A ring carries what the tool moved sideways since it touched, and lets go when it parts: the sum
// over the rings in contact. `path` runs from the first touch to the last sample.
Tangential tangential(const std::vector<Level>& path, double z, const Vec3& side, double kappa,
                      double a, bool derivatives) {
  Tangential t;
  const Level& last = path.back();
  if (z >= last.z) {
    const MeanGrowth mean = mean_growth(last.z, z, kappa, a);
    t.value = last.force + mean.value * (side - last.side);
    t.by_z = mean.by_high * (side - last.side);
    t.by_side = mean.value;
    return t;
  }
  std::size_t k = path.size() - 1;
  while (k > 0 && path[k].z > z) --k;
  const Level &low = path[k], &high = path[k + 1];
  const double width = high.z - low.z, share = (z - low.z) / width;
  const MeanGrowth mean = mean_growth(low.z, z, kappa, a);
  t.leaving = true;
  t.touched.z = z;
  t.touched.side = low.side + share * (high.side - low.side);
  t.touched.force = low.force + mean.value * (t.touched.side - low.side);
  const Growth here = growth(z, kappa, a);
  t.value = t.touched.force + here.beta * (side - t.touched.side);
  t.by_z = here.by_z * (side - t.touched.side);
  t.by_side = here.beta;
  if (!derivatives) return t;
  // At fixed z.
  const Eigen::RowVectorXd dshare = -((1 - share) * low.dz + share * high.dz) / width;
  t.touched.dside = (1 - share) * low.dside + share * high.dside + (high.side - low.side) * dshare;
  t.touched.dforce = low.dforce + mean.value * (t.touched.dside - low.dside) +
                     (t.touched.side - low.side) * (mean.by_low * low.dz);
  return t;
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
        .one_tool = true,
        .signature = "too stiff at small depth, with forces that grow like depth^1.5 there",
        .confounders = {"hyperelastic", "sensor-curve", "slack", "deadband"},
        .separated_by =
            "presses deeper than the tip's cap is high, or with a flat tool, and a calibration "
            "weight on the sensor",
        .contains = {"slack"}};
    return card;
  }

  // As a motion: the way of a flat tool that exerts the same force, so what the material does with
  // its forces in time comes after it (Lee and Radok, J. Appl. Mech. 27, 1960).
  void move(const PressView& press, const Values& values, Motion& motion) const override {
    const ParameterValue& kappa = find_value(values, "kappa");
    if (kappa.value <= 0) return;
    const bool derivatives = motion.columns > 0;
    motion.make_du();
    const LocalContact contact(press);
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - press.normal * press.normal.transpose();
    std::vector<Level> path;  // empty: no contact
    Vec3 before = Vec3::Zero();
    Eigen::MatrixXd dbefore = Eigen::MatrixXd::Zero(3, motion.columns);
    for (std::size_t i = 0; i < press.size(); ++i) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const Vec3 u = motion.u[i];
      Eigen::MatrixXd du(3, 0);
      if (derivatives) du = motion.du.middleRows(row, 3);
      if (press.in_air[i] || u.dot(press.normal) >= 0) {
        path.clear();
        motion.u[i].setZero();
        if (derivatives) motion.du.middleRows(row, 3).setZero();
      } else {
        if (path.empty()) path.push_back(first_touch(press.normal, before, u, dbefore, du));
        step(press, kappa, contact, across, du, path, motion.u[i],
             derivatives ? &motion.du : nullptr, row);
      }
      before = u;
      dbefore = du;
    }
  }

  bool full(const Values& values, double, FullSpec& spec) const override {
    spec.curvature = find_value(values, "kappa").value;
    return true;
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{20}, {100}, {400}};
  }

 private:
  // Where the straight way from the last place in the air crosses the surface.
  static Level first_touch(const Vec3& n, const Vec3& before, const Vec3& u,
                           const Eigen::MatrixXd& dbefore, const Eigen::MatrixXd& du) {
    const double above = std::max(0.0, before.dot(n)), all = above - u.dot(n);
    const Vec3 way = u - before;
    const double share = above / all;
    Level level;
    const auto along_surface = [&n](const auto& v) { return (v - n * (n.transpose() * v)).eval(); };
    level.side = along_surface((before + share * way).eval());
    if (du.cols() == 0) return level;
    Eigen::RowVectorXd dabove = n.transpose() * dbefore;
    if (above == 0) dabove.setZero();
    const Eigen::RowVectorXd dshare = ((1 - share) * dabove + share * (n.transpose() * du)) / all;
    level.dside = along_surface((dbefore + share * (du - dbefore) + way * dshare).eval());
    level.dz = Eigen::RowVectorXd::Zero(du.cols());
    level.dforce = Eigen::MatrixXd::Zero(3, du.cols());
    return level;
  }

  // Finds the local way at u, goes on with `path`, and replaces u by the flat tool's way.
  static void step(const PressView& press, const ParameterValue& kappa, const LocalContact& contact,
                   const Eigen::Matrix3d& across, const Eigen::MatrixXd& du,
                   std::vector<Level>& path, Vec3& u, Eigen::MatrixXd* motion_du,
                   Eigen::Index row) {
    const Vec3& n = press.normal;
    const double a = press.radius, k_n = contact.disc().normal, k_t = contact.disc().tangential;
    const auto law = [&](const Vec3& x) {
      LocalForce f;
      const double z = -x.dot(n);
      if (z <= 0) return f;
      const Growth g = growth(z, kappa.value, a);
      const Tangential t = tangential(path, z, across * x, kappa.value, a, false);
      f.F = k_t * t.value - k_n * g.integral * n;
      f.tangent = k_n * g.beta * n * n.transpose() + k_t * t.by_side * across -
                  k_t * t.by_z * n.transpose();
      return f;
    };
    const Vec3 tool = u;
    Vec3 x = tool;
    const LocalForce force = contact.solve(law, tool, x);
    u = tool - x + contact.disc_way(force.F);

    const double z = std::max(0.0, -x.dot(n));
    const bool derivatives = motion_du != nullptr;
    const Tangential t = tangential(path, z, across * x, kappa.value, a, derivatives);
    const Eigen::Index columns = du.cols();
    Level here{z, across * x, t.value, {}, {}, {}}, border = t.touched;
    if (derivatives) {
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
      Eigen::MatrixXd dF = k_t * dt + t.value * contact.tangential_by_columns(columns) -
                           g.integral * n * contact.normal_by_columns(columns);
      if (kappa.column >= 0) dF.col(kappa.column) -= k_n * g.integral_by_kappa * n;
      const LocalContact::Derivatives d = contact.derivatives(force, tool, x, du, dF);
      motion_du->middleRows(row, 3) = du - d.dx + contact.disc_way_derivative(force.F, d.dF);
      here.dz = -n.transpose() * d.dx;
      here.dside = across * d.dx;
      here.dforce = dt + t.by_z * here.dz + t.by_side * here.dside;
      if (t.leaving) {  // the border moved with z
        if (kappa.column >= 0)
          border.dforce.col(kappa.column) += border_by_kappa(path, border, kappa.value, a);
        const Vec3 slope = side_slope(path, z);
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

  static std::size_t segment(const std::vector<Level>& path, double z) {
    std::size_t k = path.size() - 1;
    while (k > 0 && path[k].z > z) --k;
    return k;
  }

  static Vec3 side_slope(const std::vector<Level>& path, double z) {
    const std::size_t k = segment(path, z);
    return (path[k + 1].side - path[k].side) / (path[k + 1].z - path[k].z);
  }

  static Vec3 border_by_kappa(const std::vector<Level>& path, const Level& border, double kappa,
                              double a) {
    const Level& low = path[segment(path, border.z)];
    return mean_growth(low.z, border.z, kappa, a).by_kappa * (border.side - low.side);
  }

  static Vec3 by_kappa(const std::vector<Level>& path, const Tangential& t, const Level& here,
                       double kappa, double a) {
    if (t.leaving)
      return border_by_kappa(path, t.touched, kappa, a) +
             growth(here.z, kappa, a).by_kappa * (here.side - t.touched.side);
    const Level& last = path.back();
    return mean_growth(last.z, here.z, kappa, a).by_kappa * (here.side - last.side);
  }
};

}  // namespace

const Effect& tip_effect() {
  static const Tip effect;
  return effect;
}

}  // namespace hapsim
