#include "material/hooke_law.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hapsim {
namespace {

// D and kappa with their derivatives by the constants. The part kappa 1 (x) 1 of the stiffness that
// resists a change of volume alone is handed to U, so that it can be averaged (dilatation.h).
struct Stiffness {
  VoigtMatrix D;
  double kappa = 0;
  std::vector<VoigtMatrix> D_by;
  std::vector<double> kappa_by;
};

class HookeLaw : public MaterialLaw {
 public:
  HookeLaw(std::vector<LawConstant> constants, Stiffness stiffness, StrainMeasure strain)
      : MaterialLaw(std::move(constants)),
        stiffness_(std::move(stiffness)),
        small_(strain == StrainMeasure::kSmall) {}

  bool small_strain() const override { return small_; }
  PointResponse respond(const Eigen::Matrix3d& C, bool) const override {
    const Voigt e = strain(C);
    PointResponse r;
    r.S = stiffness_.D * e;
    r.energy = 0.5 * e.dot(r.S);
    r.D = stiffness_.D;
    return r;
  }
  VolumeResponse volume(double theta) const override {
    const double k = stiffness_.kappa, x = theta - 1;
    return {k / 2 * x * x, k * x, k};
  }
  std::vector<Voigt> stress_by_constants(const Eigen::Matrix3d& C) const override {
    const Voigt e = strain(C);
    std::vector<Voigt> result;
    for (const VoigtMatrix& D : stiffness_.D_by) result.push_back(D * e);
    return result;
  }
  std::vector<double> pressure_by_constants(double theta) const override {
    std::vector<double> result;
    for (const double k : stiffness_.kappa_by) result.push_back(k * (theta - 1));
    return result;
  }

 private:
  static Voigt strain(const Eigen::Matrix3d& C) {
    Voigt e = to_voigt(0.5 * (C - Eigen::Matrix3d::Identity()));
    e.tail<3>() *= 2;
    return e;
  }
  Stiffness stiffness_;
  bool small_;
};

Voigt unit_tensor() {
  Voigt one = Voigt::Zero();
  one.head<3>().setOnes();
  return one;
}

// From the compliance and its derivatives. kappa = K - 2/3 G with the Reuss bulk modulus
// K = 1/(1.s.1): Lame's lambda when isotropic. D stays positive definite without it.
Stiffness invert(const VoigtMatrix& s, const std::vector<VoigtMatrix>& s_by, double shear,
                 const std::vector<double>& shear_by, StrainMeasure strain) {
  const Voigt one = unit_tensor();
  Stiffness result;
  result.D = s.inverse();
  const double bulk = 1 / one.dot(s * one);
  const double kappa = strain == StrainMeasure::kSmall ? bulk - 2 * shear / 3 : 0;
  result.kappa = std::max(kappa, 0.0);
  for (std::size_t k = 0; k < s_by.size(); ++k) {
    result.kappa_by.push_back(
        kappa > 0 ? -bulk * bulk * one.dot(s_by[k] * one) - 2 * shear_by[k] / 3 : 0);
    result.D_by.push_back(-result.D * s_by[k] * result.D -
                          result.kappa_by[k] * one * one.transpose());
  }
  result.D -= result.kappa * one * one.transpose();
  return result;
}

// Compliance with the axis along z.
VoigtMatrix compliance(const TransverseConstants& c) {
  VoigtMatrix s = VoigtMatrix::Zero();
  s(0, 0) = s(1, 1) = 1 / c.plane_modulus;
  s(2, 2) = 1 / c.axial_modulus;
  s(0, 1) = s(1, 0) = -c.plane_poisson / c.plane_modulus;
  s(0, 2) = s(2, 0) = s(1, 2) = s(2, 1) = -c.axial_poisson / c.axial_modulus;
  s(3, 3) = 2 * (1 + c.plane_poisson) / c.plane_modulus;
  s(4, 4) = s(5, 5) = 1 / c.axial_shear;
  return s;
}

std::vector<VoigtMatrix> compliance_by_constants(const TransverseConstants& c) {
  std::vector<VoigtMatrix> d(5, VoigtMatrix::Zero());
  const double p2 = c.plane_modulus * c.plane_modulus, a2 = c.axial_modulus * c.axial_modulus;
  d[0](0, 0) = d[0](1, 1) = -1 / p2;
  d[0](0, 1) = d[0](1, 0) = c.plane_poisson / p2;
  d[0](3, 3) = -2 * (1 + c.plane_poisson) / p2;
  d[1](2, 2) = -1 / a2;
  d[1](0, 2) = d[1](2, 0) = d[1](1, 2) = d[1](2, 1) = c.axial_poisson / a2;
  d[2](0, 1) = d[2](1, 0) = -1 / c.plane_modulus;
  d[2](3, 3) = 2 / c.plane_modulus;
  d[3](0, 2) = d[3](2, 0) = d[3](1, 2) = d[3](2, 1) = -1 / c.axial_modulus;
  d[4](4, 4) = d[4](5, 5) = -1 / (c.axial_shear * c.axial_shear);
  return d;
}

Eigen::Matrix3d frame_about(const Vec3& axis) {
  const Vec3 z = axis.normalized();
  const Vec3 x = z.unitOrthogonal();
  Eigen::Matrix3d R;
  R << x, z.cross(x), z;
  return R;
}

}  // namespace

LawPointer isotropic_law(double youngs_modulus, double poisson_ratio, StrainMeasure strain) {
  const double E = youngs_modulus, nu = poisson_ratio;
  if (!(E > 0)) fail_input("", "Young's modulus is not positive", "give E > 0");
  if (!(nu > -1 && nu < 0.5))
    fail_input("", "Poisson's ratio is outside (-1, 0.5)", "give at most 0.4999");
  const TransverseConstants c{E, E, nu, nu, E / (2 * (1 + nu))};
  const std::vector<VoigtMatrix> by = compliance_by_constants(c);
  const double G = c.axial_shear, G_by_E = G / E, G_by_nu = -G / (1 + nu);
  const std::vector<VoigtMatrix> s_by{by[0] + by[1] + G_by_E * by[4],
                                      by[2] + by[3] + G_by_nu * by[4]};
  return std::make_shared<HookeLaw>(std::vector<LawConstant>{{"E", "Pa", "Young's modulus", E},
                                                             {"nu", "1", "Poisson's ratio", nu}},
                                    invert(compliance(c), s_by, G, {G_by_E, G_by_nu}, strain),
                                    strain);
}

std::string instability(const TransverseConstants& c) {
  if (!(c.plane_modulus > 0)) return "Ep > 0 fails";
  if (!(c.axial_modulus > 0)) return "Ea > 0 fails";
  if (!(c.axial_shear > 0)) return "Ga > 0 fails";
  if (!(std::abs(c.plane_poisson) < 1)) return "|nup| < 1 fails";
  const double rest = 1 - c.plane_poisson -
                      2 * c.axial_poisson * c.axial_poisson * c.plane_modulus / c.axial_modulus;
  if (!(rest > 0)) return "1 - nup - 2 nua^2 Ep/Ea > 0 fails";
  return "";
}

LawPointer transverse_law(const TransverseConstants& c, const Vec3& axis, StrainMeasure strain) {
  const std::string unstable = instability(c);
  if (!unstable.empty())
    fail_input("", "the transversely isotropic constants have no positive energy: " + unstable,
               "lower the Poisson's ratios or check the order of the constants");
  if (!(axis.norm() > 0)) fail_input("", "the axis of the material is zero", "give its direction");
  const double G = c.plane_modulus / (2 * (1 + c.plane_poisson));
  Stiffness stiffness = invert(compliance(c), compliance_by_constants(c), G,
                               {G / c.plane_modulus, 0, -G / (1 + c.plane_poisson), 0, 0}, strain);
  const VoigtMatrix T = stress_rotation(frame_about(axis));
  stiffness.D = T * stiffness.D * T.transpose();
  for (VoigtMatrix& D : stiffness.D_by) D = T * D * T.transpose();
  return std::make_shared<HookeLaw>(
      std::vector<LawConstant>{
          {"Ep", "Pa", "Young's modulus across the axis", c.plane_modulus},
          {"Ea", "Pa", "Young's modulus along the axis", c.axial_modulus},
          {"nup", "1", "contraction across the axis by tension across it", c.plane_poisson},
          {"nua", "1", "contraction across the axis by tension along it", c.axial_poisson},
          {"Ga", "Pa", "shear modulus between axis and plane", c.axial_shear}},
      std::move(stiffness), strain);
}

}  // namespace hapsim
