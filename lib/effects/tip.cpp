// A tool with a spherical tip: the contact grows with the depth until the whole tool is in contact.
#include <algorithm>
#include <cmath>
#include <optional>

#include "effects/effect_step.h"
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
// `side`, when the tangential force over k_t was `force`.
struct Ring {
  double z = 0;
  Vec3 side = Vec3::Zero(), force = Vec3::Zero();
};

// Tangential force over k_t at depth z and sideways place `side`.
struct Tangential {
  Vec3 value = Vec3::Zero(), by_z = Vec3::Zero();
  double by_side = 0;
  bool leaving = false;
  // Leaving: the ring at the contact's border, between which rings of the path it lies and how far.
  Ring touched;
  std::size_t segment = 0;
  double share = 0;
  MeanGrowth mean;
};

// A ring carries what the tool moved sideways since it touched, and lets go when it parts: the sum
// over the rings in contact. `path` runs from the first touch to the last sample, its depths do not
// fall.
template <class Path>
Tangential tangential(const Path& path, double z, const Vec3& side, double kappa, double a) {
  Tangential t;
  const Ring& last = path[path.size() - 1];
  if (z >= last.z) {
    const MeanGrowth mean = mean_growth(last.z, z, kappa, a);
    t.value = last.force + mean.value * (side - last.side);
    t.by_z = mean.by_high * (side - last.side);
    t.by_side = mean.value;
    return t;
  }
  std::size_t k = 0;  // the last ring that is not deeper, or the first of all
  for (std::size_t end = path.size(); end - k > 1;) {
    const std::size_t middle = k + (end - k) / 2;
    (path[middle].z > z ? end : k) = middle;
  }
  const Ring &low = path[k], &high = path[k + 1];
  t.leaving = true;
  t.segment = k;
  t.share = (z - low.z) / (high.z - low.z);
  t.mean = mean_growth(low.z, z, kappa, a);
  t.touched.z = z;
  t.touched.side = low.side + t.share * (high.side - low.side);
  t.touched.force = low.force + t.mean.value * (t.touched.side - low.side);
  const Growth here = growth(z, kappa, a);
  t.value = t.touched.force + here.beta * (side - t.touched.side);
  t.by_z = here.by_z * (side - t.touched.side);
  t.by_side = here.beta;
  return t;
}

// The tip on the way `path` into the material.
template <class Path>
struct TipLaw {
  const Path& path;
  const LocalContact& contact;
  const Vec3& n;
  double kappa, a;
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - n * n.transpose();

  LocalForce operator()(const Vec3& x) const {
    LocalForce f;
    const double z = -x.dot(n), k_n = contact.disc().normal, k_t = contact.disc().tangential;
    if (z <= 0) return f;
    const Growth g = growth(z, kappa, a);
    const Tangential t = tangential(path, z, across * x, kappa, a);
    f.F = k_t * t.value - k_n * g.integral * n;
    f.tangent =
        k_n * g.beta * n * n.transpose() + k_t * t.by_side * across - k_t * t.by_z * n.transpose();
    return f;
  }
};

// The sideways place where the straight way from `before`, in the air, to u crosses the surface.
struct FirstTouch {
  double above = 0, all = 0, share = 0;
  Vec3 side = Vec3::Zero();
};
FirstTouch first_touch(const Vec3& n, const Vec3& before, const Vec3& u) {
  FirstTouch touch;
  touch.above = std::max(0.0, before.dot(n));
  touch.all = touch.above - u.dot(n);
  touch.share = touch.above / touch.all;
  const Vec3 place = before + touch.share * (u - before);
  touch.side = place - n * (n.transpose() * place);
  return touch;
}

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

// The way in as numbers in a loop's memory: their count, then the rings. When it is full every
// second ring is forgotten, those at its ends apart.
class PathMemory {
 public:
  static constexpr std::size_t kMost = 4096, kNumbers = 1 + 7 * kMost;
  explicit PathMemory(double* memory) : memory_(memory) {}
  std::size_t size() const { return static_cast<std::size_t>(memory_[0]); }
  bool empty() const { return memory_[0] == 0; }
  void clear() { memory_[0] = 0; }
  Ring operator[](std::size_t k) const {
    const double* ring = at(k);
    return {ring[0], Eigen::Map<const Vec3>(ring + 1), Eigen::Map<const Vec3>(ring + 4)};
  }
  void pop_back() { --memory_[0]; }
  void push_back(const Ring& ring) {
    if (size() == kMost) forget_half();
    put(size(), ring);
    ++memory_[0];
  }
  // The same, in stead of a last ring as deep as this and as the one before it, which no other asks
  // for: a tool that is held still adds nothing.
  void go_on(const Ring& ring, double still) {
    if (size() > 1 && ring.z - at(size() - 2)[0] <= still) pop_back();
    push_back(ring);
  }

 private:
  double* at(std::size_t k) const { return memory_ + 1 + 7 * k; }
  void put(std::size_t k, const Ring& ring) {
    at(k)[0] = ring.z;
    Eigen::Map<Vec3>(at(k) + 1) = ring.side;
    Eigen::Map<Vec3>(at(k) + 4) = ring.force;
  }
  void forget_half() {
    std::size_t kept = 1;
    for (std::size_t k = 2; k < kMost - 1; k += 2) put(kept++, (*this)[k]);
    put(kept++, (*this)[kMost - 1]);
    memory_[0] = static_cast<double>(kept);
  }
  double* memory_;
};

// Remembers the last displacement and the way in.
class TipStep : public EffectStep {
 public:
  TipStep(double kappa, double radius) : kappa_(kappa), radius_(radius) {}
  std::size_t memory() const override { return 3 + PathMemory::kNumbers; }
  void take_place(const StepPlace& place) noexcept override {
    stiffness_ = place.contact;
    normal_ = place.normal;
    contact_.emplace(stiffness_, normal_, radius_);
  }
  void move(StepSample& sample, double* memory) noexcept override {
    Eigen::Map<Vec3> before(memory);
    PathMemory path(memory + 3);
    if (sample.first) {
      before.setZero();
      path.clear();
    }
    const Vec3 tool = sample.u;
    if (sample.in_air || !contact_ || tool.dot(normal_) >= 0) {
      path.clear();
      sample.u.setZero();
    } else {
      if (path.empty()) path.push_back({0, first_touch(normal_, before, tool).side, Vec3::Zero()});
      press(tool, path, sample.u);
    }
    before = tool;
  }

 private:
  // Where no equilibrium is found the tool is a flat one for that sample.
  void press(const Vec3& tool, PathMemory& path, Vec3& u) const noexcept {
    const TipLaw<PathMemory> law{path, *contact_, normal_, kappa_, radius_};
    Vec3 x = tool;
    LocalForce force;
    if (!contact_->find(law, tool, x, force)) return;
    u = tool - x + contact_->disc_way(force.F);
    const double z = std::max(0.0, -x.dot(normal_));
    const Tangential t = tangential(path, z, law.across * x, kappa_, radius_);
    if (t.leaving) {
      while (path.size() > 1 && path[path.size() - 1].z > z) path.pop_back();
      path.push_back(t.touched);
    }
    path.go_on({z, law.across * x, t.value}, 1e-13 * radius_);
  }

  double kappa_, radius_;
  Vec3 normal_ = Vec3::UnitZ();
  ContactStiffness stiffness_;
  std::optional<LocalContact> contact_;  // of stiffness_
};

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
        .contains = {"slack"},
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
        if (path.empty()) path.push_back(touch_level(press.normal, before, u, dbefore, du));
        step(press, kappa, contact, du, path, motion.u[i], derivatives ? &motion.du : nullptr, row);
      }
      before = u;
      dbefore = du;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    const double kappa = find_value(values, "kappa").value;
    if (kappa <= 0) return nullptr;
    return std::make_unique<TipStep>(kappa, context.tool_radius);
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
                   const Eigen::MatrixXd& du, std::vector<Level>& path, Vec3& u,
                   Eigen::MatrixXd* motion_du, Eigen::Index row) {
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
    const Eigen::Index columns = du.cols();
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

const Effect& tip_effect() {
  static const Tip effect;
  return effect;
}

}  // namespace hapsim
