// A tool that is wider or narrower than declared.
#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/local_contact.h"

namespace hapsim {
namespace {

// How many times as stiff as the half-space a body is against a tool s times as wide, where it is r
// times as stiff against the declared one. A support makes it stiffer in proportion to the radius;
// what gives way far from the tool is in series with what is under it. Both are one to first order.
struct Stiffer {
  double value, by_r, by_s;
};
Stiffer stiffer(double r, double s) {
  if (r >= 1) return {1 + s * (r - 1), s, r - 1};
  const double d = r + s * (1 - r);
  return {r / d, s / (d * d), -r * (1 - r) / (d * d)};
}

// A function of the disc's stiffness along the normal and across it.
Eigen::Matrix3d along_across(double along, double across, const Vec3& n) {
  return across * Eigen::Matrix3d::Identity() + (along - across) * n * n.transpose();
}

// The map M = K(s a) K(a)^-1 of forces and its derivatives.
class WiderTool {
 public:
  WiderTool(const ContactStiffness& contact, const Vec3& normal, double radius, double s)
      : contact_(contact),
        normal_(normal),
        disc_(bonded_disc(contact.modulus, contact.nu, radius)),
        s_(s),
        root_(along_across(std::sqrt(disc_.normal), std::sqrt(disc_.tangential), normal)),
        inverse_root_(
            along_across(1 / std::sqrt(disc_.normal), 1 / std::sqrt(disc_.tangential), normal)),
        inverse_(contact.K.inverse()) {
    const Eigen::Matrix3d A = inverse_root_ * contact.K * inverse_root_;
    modes_.compute(0.5 * (A + A.transpose()));
    for (int k = 0; k < 3; ++k) stiffer_[k] = stiffer(modes_.eigenvalues()[k], s);
    const auto& Q = modes_.eigenvectors();
    const Vec3 values(stiffer_[0].value, stiffer_[1].value, stiffer_[2].value);
    ratio_ = Q * values.asDiagonal() * Q.transpose();
    map_ = s * root_ * ratio_ * root_ * inverse_;
  }

  const Eigen::Matrix3d& map() const { return map_; }

  Eigen::Matrix3d by_s() const {
    const auto& Q = modes_.eigenvectors();
    const Vec3 slopes(stiffer_[0].by_s, stiffer_[1].by_s, stiffer_[2].by_s);
    return map_ / s_ + s_ * root_ * (Q * slopes.asDiagonal() * Q.transpose()) * root_ * inverse_;
  }

  // For a change of the body's stiffness and of the disc's two.
  Eigen::Matrix3d by(const Eigen::Matrix3d& dK, double dnormal, double dtangential) const {
    const double n = disc_.normal, t = disc_.tangential;
    const Eigen::Matrix3d droot =
        along_across(dnormal / (2 * std::sqrt(n)), dtangential / (2 * std::sqrt(t)), normal_);
    const Eigen::Matrix3d dinverse = along_across(-dnormal / (2 * n * std::sqrt(n)),
                                                  -dtangential / (2 * t * std::sqrt(t)), normal_);
    const Eigen::Matrix3d half = dinverse * contact_.K * inverse_root_;
    const auto& Q = modes_.eigenvectors();
    Eigen::Matrix3d d =
        Q.transpose() * (half + half.transpose() + inverse_root_ * dK * inverse_root_) * Q;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) d(i, j) *= slope(i, j);
    const Eigen::Matrix3d dratio = Q * d * Q.transpose();
    const Eigen::Matrix3d side = droot * ratio_ * root_;
    return s_ * (side + side.transpose() + root_ * dratio * root_) * inverse_ -
           map_ * dK * inverse_;
  }

  // Its derivatives by all columns that the material has.
  std::vector<std::pair<int, Eigen::Matrix3d>> by_material() const {
    std::vector<std::pair<int, Eigen::Matrix3d>> d;
    const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
    for (const auto& [column, dK] : contact_.by_column) d.emplace_back(column, by(dK, 0, 0));
    for (const auto& [column, slope] : contact_.log_modulus_by_column)
      d.emplace_back(column, by(none, disc_.normal * slope, disc_.tangential * slope));
    if (contact_.nu_column >= 0)
      d.emplace_back(contact_.nu_column, by(none, disc_.normal_by_nu, disc_.tangential_by_nu));
    return d;
  }

 private:
  // Of a function of a symmetric matrix: its divided differences (Daleckii and Krein, 1965).
  double slope(int i, int j) const {
    const double step = modes_.eigenvalues()[i] - modes_.eigenvalues()[j];
    if (std::abs(step) < 1e-6) return 0.5 * (stiffer_[i].by_r + stiffer_[j].by_r);
    return (stiffer_[i].value - stiffer_[j].value) / step;
  }

  const ContactStiffness& contact_;
  Vec3 normal_;
  DiscStiffness disc_;
  double s_;
  Eigen::Matrix3d root_, inverse_root_, inverse_, ratio_, map_;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes_;
  std::array<Stiffer, 3> stiffer_;
};

class RadiusStep : public EffectStep {
 public:
  RadiusStep(double s, double radius) : s_(s), radius_(radius) {}
  void take_place(const StepPlace& place) noexcept override {
    map_ = WiderTool(place.contact, place.normal, radius_, s_).map();
  }
  void apply(const StepSample&, double*, Vec3& f) noexcept override { f = (map_ * f).eval(); }

 private:
  double s_, radius_;
  Eigen::Matrix3d map_ = Eigen::Matrix3d::Identity();
};

class ToolRadius : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "tool-radius",
        .stage = Stage::kContact,
        .title = "the tool is wider or narrower than declared",
        .equation =
            "f = K(s a)/K(a) f(a); K(a) = r D(a), D = s D(a) of a disc bonded to a half-space of "
            "the body's material; r - 1 goes with the radius where the body is stiffer than that "
            "(r > 1: its support), 1/r - 1 where it is softer (what gives way far from the tool is "
            "in series); in the principal directions of K over D",
        .source =
            "bonded disc: Spence, Proc. R. Soc. A 305, 1968; along the surface: Mindlin, J. Appl. "
            "Mech. 16, 1949; a finite body to first order in the radius over its size, and the "
            "square of the radius of a thin layer",
        .assumptions =
            "a flat tool; exact beside a material that relaxes everywhere alike. For twice the "
            "radius the force is within 1.5 % on a block six of the wider tool's radii thick, 3 % "
            "on three, 8 % on one and a half (contact meshes of both radii)",
        .parameters = {{"s", "1", "true radius over that declared", 1, 1, 0.2, 5, 0.1, false}},
        .needs_positions = true,
        .needs_rim = true,
        .needs_flat = true,
        .one_tool = true,
        .signature =
            "like another Young's modulus, but the more the stiffer the support makes a place, the "
            "less the more the body gives way as a whole",
        .confounders = {"base", "anisotropic", "layer", "arm-compliance"},
        .separated_by = "the tool, measured; presses with a tool of another radius",
        .kinds = {"set-up", "body"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const ParameterValue& s = find_value(values, "s");
    if (s.value == 1 && s.column < 0) return;
    const WiderTool wider(press.contact, press.normal, press.radius, s.value);
    auto by_column = wider.by_material();
    if (s.column >= 0) by_column.emplace_back(s.column, wider.by_s());
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(press.size()); ++i) {
      const Vec3 f = signal.f.segment<3>(3 * i);
      signal.f.segment<3>(3 * i) = wider.map() * f;
      if (signal.df.cols() == 0) continue;
      auto df = signal.df.middleRows(3 * i, 3);
      df = (wider.map() * df).eval();
      for (const auto& [column, dM] : by_column) df.col(column) += dM * f;
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values,
                                   const StepContext& context) const override {
    return std::make_unique<RadiusStep>(find_value(values, "s").value, context.tool_radius);
  }

  std::vector<std::vector<double>> starts(const DataSummary&, int) const override {
    return {{0.7}, {1.5}};
  }
};

}  // namespace

const Effect& tool_radius_effect() {
  static const ToolRadius effect;
  return effect;
}

}  // namespace hapsim
