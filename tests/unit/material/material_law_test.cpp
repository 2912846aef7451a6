// Stresses, tangents and parameter derivatives of the material laws, against differences and closed
// forms.
#include "material/material_law.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>

#include "expect_error.h"
#include "material/hooke_law.h"
#include "material/hyperelastic_law.h"
#include "material/ogden_law.h"

namespace hapsim {
namespace {

using Eigen::Matrix3d;

struct Named {
  std::string name;
  // The law for given constants.
  std::function<LawPointer(const std::vector<double>&)> make;
  std::vector<double> constants;
};

std::vector<Named> all_laws() {
  const Vec3 axis(1, 2, -0.5);
  const auto transverse = [axis](StrainMeasure strain) {
    return [axis, strain](const std::vector<double>& c) {
      return transverse_law({c[0], c[1], c[2], c[3], c[4]}, axis, strain);
    };
  };
  return {
      {"neo-Hookean",
       [](const std::vector<double>& c) { return neo_hookean_law(c[0], c[1]); },
       {4e3, 5e4}},
      {"Yeoh",
       [](const std::vector<double>& c) { return yeoh_law(c[0], c[1], c[2], c[3]); },
       {2e3, -300, 800, 3e4}},
      {"exponential",
       [](const std::vector<double>& c) { return exponential_law(c[0], c[1], c[2]); },
       {4e3, 2.5, 5e4}},
      {"Ogden",
       [](const std::vector<double>& c) {
         return ogden_law({{c[0], c[1]}, {c[2], c[3]}}, c[4]);
       },
       {3e3, 1.3, 900, -2.5, 5e4}},
      {"isotropic, small strain",
       [](const std::vector<double>& c) { return isotropic_law(c[0], c[1]); },
       {1e4, 0.45}},
      {"isotropic, Green-Lagrange",
       [](const std::vector<double>& c) {
         return isotropic_law(c[0], c[1], StrainMeasure::kGreenLagrange);
       },
       {1e4, 0.3}},
      {"transverse, small strain", transverse(StrainMeasure::kSmall), {1e4, 4e4, 0.4, 0.3, 6e3}},
      {"transverse, Green-Lagrange",
       transverse(StrainMeasure::kGreenLagrange),
       {1e4, 4e4, 0.4, 0.3, 6e3}},
  };
}

Matrix3d some_C() {
  Matrix3d F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.15, -0.2, 0.1, 1.2;
  return F.transpose() * F;
}

// E + h in one Voigt component (engineering shear).
Matrix3d shifted(const Matrix3d& C, int k, double h) {
  Matrix3d result = C;
  const auto [i, j] = kVoigtPairs[k];
  result(i, j) += i == j ? 2 * h : h;
  if (i != j) result(j, i) += h;
  return result;
}

TEST(MaterialLaw, StressIsTheEnergysSlopeAndTangentTheStress) {
  const Matrix3d C = some_C();
  const double h = 1e-6;
  for (const Named& n : all_laws()) {
    const LawPointer law = n.make(n.constants);
    const PointResponse r = law->respond(C, true);
    for (int k = 0; k < 6; ++k) {
      const PointResponse up = law->respond(shifted(C, k, h), false);
      const PointResponse down = law->respond(shifted(C, k, -h), false);
      EXPECT_NEAR((up.energy - down.energy) / (2 * h), r.S[k], 1e-7 * r.D.norm()) << n.name << k;
      EXPECT_LT(((up.S - down.S) / (2 * h) - r.D.col(k)).norm(), 1e-7 * r.D.norm()) << n.name << k;
    }
    EXPECT_LT((r.D - r.D.transpose()).norm(), 1e-12 * r.D.norm()) << n.name;
    const VolumeResponse v = law->volume(0.9);
    const double first = (law->volume(0.9 + h).energy - law->volume(0.9 - h).energy) / (2 * h);
    const double second = (law->volume(0.9 + h).first - law->volume(0.9 - h).first) / (2 * h);
    EXPECT_NEAR(first, v.first, 1e-7 * std::abs(v.second)) << n.name;
    EXPECT_NEAR(second, v.second, 1e-7 * std::abs(v.second)) << n.name;
  }
}

TEST(MaterialLaw, DerivativesByConstantsAreTheDifferences) {
  const Matrix3d C = some_C();
  for (const Named& n : all_laws()) {
    const LawPointer law = n.make(n.constants);
    ASSERT_EQ(law->constants().size(), n.constants.size()) << n.name;
    const auto S_by = law->stress_by_constants(C);
    const auto p_by = law->pressure_by_constants(0.9);
    for (std::size_t k = 0; k < n.constants.size(); ++k) {
      EXPECT_EQ(law->constants()[k].value, n.constants[k]) << n.name;
      std::vector<double> up = n.constants, down = n.constants;
      const double h = 1e-5 * std::abs(n.constants[k]);
      up[k] += h;
      down[k] -= h;
      const LawPointer a = n.make(up), b = n.make(down);
      const Voigt difference = (a->respond(C, false).S - b->respond(C, false).S) / (2 * h);
      const double p = (a->volume(0.9).first - b->volume(0.9).first) / (2 * h);
      const double scale = law->respond(C, false).S.norm() / std::abs(n.constants[k]);
      EXPECT_LT((difference - S_by[k]).norm(), 1e-7 * scale) << n.name << " constant " << k;
      EXPECT_NEAR(p, p_by[k], 1e-7 * std::abs(law->volume(0.9).first / n.constants[k])) << n.name;
    }
  }
}

// Every law is Hooke's at small strain: the tangents in the undeformed state.
TEST(MaterialLaw, SmallStrainLimitIsHookes) {
  const double E = 1e4, nu = 0.45;
  const Moduli m = moduli(E, nu);
  const auto tangent = [](const LawPointer& law) {
    VoigtMatrix D = law->respond(Matrix3d::Identity(), true).D;
    D.topLeftCorner<3, 3>().array() += law->volume(1).second;
    return D;
  };
  const VoigtMatrix hooke = tangent(isotropic_law(E, nu));
  EXPECT_NEAR(hooke(0, 0), E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)), 1e-9 * E);
  EXPECT_NEAR(hooke(3, 3), m.mu, 1e-9 * E);
  for (const LawPointer& law :
       {neo_hookean_law(m.mu, m.bulk), yeoh_law(m.mu / 2, 700, -20, m.bulk),
        exponential_law(m.mu, 3, m.bulk), ogden_law({{0.7 * m.mu, 4}, {0.3 * m.mu, -2}}, m.bulk),
        isotropic_law(E, nu, StrainMeasure::kGreenLagrange),
        transverse_law({E, E, nu, nu, m.mu}, {0, 1, 1})})
    EXPECT_LT((tangent(law) - hooke).norm(), 1e-11 * hooke.norm());
  const Moduli up = moduli(E, nu + 1e-6), down = moduli(E, nu - 1e-6);
  EXPECT_NEAR((up.mu - down.mu) / 2e-6, moduli_by_poisson(E, nu).mu, 1e-6 * E);
  EXPECT_NEAR((up.bulk - down.bulk) / 2e-6, moduli_by_poisson(E, nu).bulk, 1e-4 * E);
}

// One term of alpha = 2 is neo-Hookean; stretches that are equal, and nearly so, take the tangent's
// limit.
TEST(MaterialLaw, OgdenIsNeoHookeanAndSmoothWhereStretchesMeet) {
  const LawPointer ogden = ogden_law({{4e3, 2}}, 5e4), neo = neo_hookean_law(4e3, 5e4);
  for (const double apart : {0.0, 1e-9, 1e-6, 3e-6, 1e-5, 1e-4, 0.1}) {
    Matrix3d R(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()));
    const Matrix3d C = R * Vec3(1.3, 1.3 + apart, 0.8).asDiagonal() * R.transpose();
    const PointResponse a = ogden->respond(C, true), b = neo->respond(C, true);
    EXPECT_NEAR(a.energy, b.energy, 1e-9 * b.energy);
    EXPECT_LT((a.S - b.S).norm(), 1e-9 * b.D.norm()) << apart;
    EXPECT_LT((a.D - b.D).norm(), 1e-8 * b.D.norm()) << apart;
  }
  EXPECT_THROW(ogden_law({}, 1e4), Error);
  EXPECT_THROW(ogden_law({{1e3, 0}}, 1e4), Error);
}

// The compliance seen along and across the axis is what the constants say.
TEST(MaterialLaw, TransverseConstantsAreWhatTheySay) {
  const TransverseConstants c{1e4, 4e4, 0.4, 0.3, 6e3};
  const LawPointer law = transverse_law(c, {2, 0, 0});
  VoigtMatrix D = law->respond(Matrix3d::Identity(), true).D;
  D.topLeftCorner<3, 3>().array() += law->volume(1).second;
  const VoigtMatrix s = D.inverse();
  EXPECT_NEAR(1 / s(0, 0), c.axial_modulus, 1e-6);
  EXPECT_NEAR(1 / s(1, 1), c.plane_modulus, 1e-6);
  EXPECT_NEAR(-s(1, 0) / s(0, 0), c.axial_poisson, 1e-9);
  EXPECT_NEAR(-s(2, 1) / s(1, 1), c.plane_poisson, 1e-9);
  EXPECT_NEAR(1 / s(3, 3), c.axial_shear, 1e-6);
  EXPECT_NEAR(1 / s(4, 4), c.plane_modulus / (2 * (1 + c.plane_poisson)), 1e-6);
}

// Lempriere's bounds are those at which the stiffness loses its positive eigenvalues.
TEST(MaterialLaw, StabilityBoundsAreTheEigenvalues) {
  EXPECT_EQ(instability({1e4, 4e4, 0.4, 0.3, 6e3}), "");
  EXPECT_NE(instability({1e4, 4e4, 1.0, 0.3, 6e3}), "");
  EXPECT_NE(instability({1e4, 4e4, 0.4, 0.3, 0}), "");
  const double bound = std::sqrt((1 - 0.4) / 2 * 4);  // nua at Ea = 4 Ep
  EXPECT_EQ(instability({1e4, 4e4, 0.4, bound - 1e-6, 6e3}), "");
  EXPECT_NE(instability({1e4, 4e4, 0.4, bound + 1e-6, 6e3}), "");
  EXPECT_THROW(transverse_law({1e4, 4e4, 0.4, bound + 1e-6, 6e3}, {1, 0, 0}), Error);
  EXPECT_THROW(isotropic_law(1e4, 0.5), Error);
  EXPECT_THROW(neo_hookean_law(-1, 1e4), Error);
}

}  // namespace
}  // namespace hapsim
