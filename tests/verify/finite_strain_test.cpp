// Homogeneous finite strain against closed forms, by elements and by the law alone, and a fit to
// Treloar's rubber.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "material/hyperelastic_law.h"
#include "material/ogden_law.h"
#include "nonlinear/nonlinear_body.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

using Eigen::Matrix3d;

// A law with its W1 = df/dI1bar, from which the closed forms follow (Ogden, Non-Linear Elastic
// Deformations, 1984, ch. 4; Treloar, The Physics of Rubber Elasticity, 1975, ch. 5).
struct Known {
  const char* name;
  std::function<LawPointer(double bulk)> law;
  std::function<double(double x)> w1;  // of I1 - 3
};

std::vector<Known> known_laws() {
  return {
      {"neo-Hooke", [](double K) { return neo_hookean_law(4e3, K); }, [](double) { return 2e3; }},
      {"Yeoh", [](double K) { return yeoh_law(2e3, -150, 60, K); },
       [](double x) { return 2e3 - 2 * 150 * x + 3 * 60 * x * x; }},
      {"exponential", [](double K) { return exponential_law(4e3, 0.4, K); },
       [](double x) { return 2e3 * std::exp(0.4 * x); }}};
}

// A cube between handles on z = 0 and z = 1 with the sides free is uniaxial when the ends may
// slide; the laws' stresses are the elements' (patch test), so the free sides are found on the law:
// the lateral stretch at which the lateral stress vanishes.
Matrix3d with_free_sides(const MaterialLaw& law, double stretch, bool equibiaxial) {
  double other = equibiaxial ? 1 / (stretch * stretch) : 1 / std::sqrt(stretch);
  for (int k = 0; k < 50; ++k) {
    const auto stress = [&](double l) {
      const Vec3 d = equibiaxial ? Vec3(l, stretch, stretch) : Vec3(l, l, stretch);
      return nominal_stress(law, d.asDiagonal())(0, 0);
    };
    const double h = 1e-7, slope = (stress(other + h) - stress(other - h)) / (2 * h);
    other -= stress(other) / slope;
  }
  const Vec3 d = equibiaxial ? Vec3(other, stretch, stretch) : Vec3(other, other, stretch);
  return d.asDiagonal();
}

// Incompressible: P = 2 W1 (l - l^-2) and 2 W1 (l - l^-5). A bulk modulus K leaves a share of
// stress/K, first order in 1/K, so two of them extrapolate to it.
TEST(FiniteStrain, UniaxialAndEquibiaxialTension) {
  for (const Known& k : known_laws())
    for (const bool equibiaxial : {false, true})
      for (const double l : {0.6, 0.8, 1.3, 2.0}) {
        const auto stress = [&](double bulk) {
          const LawPointer law = k.law(bulk);
          return nominal_stress(*law, with_free_sides(*law, l, equibiaxial))(2, 2);
        };
        const double I1 = equibiaxial ? 2 * l * l + std::pow(l, -4) : l * l + 2 / l;
        const double exact = 2 * k.w1(I1 - 3) * (l - std::pow(l, equibiaxial ? -5 : -2));
        const double a = stress(1e9), b = stress(1e10);
        EXPECT_NEAR(a, exact, 0.01 * std::abs(exact)) << k.name << " " << l;
        EXPECT_NEAR((10 * b - a) / 9, exact, 1e-6 * std::abs(exact)) << k.name << " " << l;
      }
}

// Simple shear is isochoric: Cauchy shear 2 W1 gamma for any K, normal stress differences by
// Rivlin's universal relation s_xx - s_yy = gamma s_xy.
TEST(FiniteStrain, SimpleShear) {
  for (const Known& k : known_laws())
    for (const double gamma : {0.1, 0.5, 1.0}) {
      Matrix3d F = Matrix3d::Identity();
      F(0, 1) = gamma;
      const Matrix3d cauchy = nominal_stress(*k.law(5e4), F) * F.transpose();
      const double exact = 2 * k.w1(gamma * gamma) * gamma;
      EXPECT_NEAR(cauchy(0, 1), exact, 1e-10 * exact) << k.name;
      EXPECT_NEAR(cauchy(0, 0) - cauchy(1, 1), gamma * cauchy(0, 1), 1e-10 * exact) << k.name;
    }
}

// By elements: a column of 1 x 1 x 2 whose ends slide, stretched by a third; compressible law.
TEST(FiniteStrain, ColumnOfElementsIsUniaxial) {
  for (const Known& k : known_laws())
    for (const int order : {1, 2}) {
      const LawPointer law = k.law(2e4);
      const TetMesh mesh = test::block_mesh({1, 1, 2}, 2, 2, 3, order, 0.2);
      // Sliding planes x = 0, y = 0, z = 0 and z = 2 moved, as stiff springs and dead loads would
      // only approximate it: the law's own lateral stretch is prescribed on the outer nodes and the
      // sides must come out free of force.
      const double l = 4.0 / 3;
      const Matrix3d F = with_free_sides(*law, l, false);
      std::vector<int> handle(mesh.nodes.size(), kFreeNode);
      int handles = 0;
      for (std::size_t i = 0; i < handle.size(); ++i)
        if (mesh.nodes[i].z() < 1e-9 || mesh.nodes[i].z() > 2 - 1e-9) handle[i] = handles++;
      Eigen::VectorXd prescribed(3 * handles);
      for (std::size_t i = 0; i < handle.size(); ++i)
        if (handle[i] >= 0)
          prescribed.segment<3>(3 * handle[i]) = F * mesh.nodes[i] - mesh.nodes[i];
      NonlinearBody body(BodyModel{&mesh, {law}}, handle);
      ASSERT_TRUE(body.solve(prescribed, {1e-12}).ok());
      Vec3 force = Vec3::Zero();
      for (std::size_t i = 0; i < handle.size(); ++i)
        if (mesh.nodes[i].z() > 2 - 1e-9)
          force += body.nodal_forces().segment<3>(3 * static_cast<Eigen::Index>(i));
      const double exact = nominal_stress(*law, F)(2, 2);
      EXPECT_NEAR(force.z(), exact, 1e-9 * exact) << k.name << " order " << order;
      EXPECT_LT(force.head<2>().norm(), 1e-9 * exact) << k.name;
    }
}

// Vulcanised rubber at 20 degC: nominal stress [MPa] and stretch of Treloar, Trans. Faraday Soc.
// 40, 1944, as digitised by C. Zhao (github.com/Chongran-Zhao/Hyperelastic-fitting, Treloar_1944;
// his stresses are Treloar's in kg/cm^2, two decimals, times 0.0980665). The first rows (below 3 %
// strain) have one digit only and are left out.
using Rows = std::vector<std::array<double, 2>>;
const Rows kTension{{0.1344, 1.125}, {0.2256, 1.24}, {0.3169, 1.39}, {0.4081, 1.585},
                    {0.5003, 1.90},  {0.5886, 2.18}, {0.6769, 2.42}, {0.8633, 3.02},
                    {1.0497, 3.57},  {1.2263, 4.03}, {1.5892, 4.76}, {1.9522, 5.36},
                    {2.3152, 5.75},  {2.6879, 6.15}, {3.0411, 6.40}, {3.4139, 6.60},
                    {3.7769, 6.85},  {4.1300, 7.05}, {4.4930, 7.15}, {4.8658, 7.25},
                    {5.2287, 7.40},  {5.5917, 7.50}, {6.3176, 7.60}};
const Rows kEquibiaxial{{0.1570, 1.065}, {0.2387, 1.115}, {0.2570, 1.14}, {0.3282, 1.20},
                        {0.4364, 1.31},  {0.5146, 1.42},  {0.6557, 1.68}, {0.7652, 1.94},
                        {0.9617, 2.49},  {1.2386, 3.03},  {1.4401, 3.43}, {1.7096, 3.75},
                        {1.9845, 4.07},  {2.2065, 4.26},  {2.4426, 4.45}};
const Rows kPureShear{{0.1589, 1.12}, {0.2452, 1.19}, {0.3326, 1.31}, {0.4189, 1.46},
                      {0.5925, 1.84}, {0.7652, 2.38}, {0.9418, 2.97}, {1.1183, 3.47},
                      {1.2851, 3.95}, {1.4617, 4.37}, {1.6285, 4.69}, {1.8050, 4.97}};

// Yeoh's law, linear in its constants, fitted to relative stresses by least squares; neo-Hooke
// cannot follow the upturn.
TEST(FiniteStrain, YeohFollowsTreloarsRubber) {
  const int rows = static_cast<int>(kTension.size());
  Eigen::MatrixXd A(rows, 3);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(rows);
  for (int i = 0; i < rows; ++i) {
    const auto [stress, l] = kTension[static_cast<std::size_t>(i)];
    const double x = l * l + 2 / l - 3, unit = 2 * (l - 1 / (l * l)) / stress;
    A.row(i) << unit, 2 * x * unit, 3 * x * x * unit;
  }
  const Eigen::Vector3d c = A.colPivHouseholderQr().solve(b);
  std::printf("Treloar: C10 %.4f, C20 %.3g, C30 %.3g MPa\n", c[0], c[1], c[2]);
  const LawPointer yeoh = yeoh_law(c[0], c[1], c[2], 2000);
  const LawPointer neo = neo_hookean_law(2 * c[0], 2000);
  double squares = 0, worst_neo = 0;
  for (const auto& [stress, l] : kTension) {
    const double fitted = nominal_stress(*yeoh, with_free_sides(*yeoh, l, false))(2, 2);
    squares += std::pow(fitted / stress - 1, 2);
    worst_neo = std::max(
        worst_neo,
        std::abs(nominal_stress(*neo, with_free_sides(*neo, l, false))(2, 2) / stress - 1));
  }
  const double rms = std::sqrt(squares / rows);
  std::printf("Treloar: Yeoh rms %.1f %%, neo-Hooke worst %.0f %%\n", 100 * rms, 100 * worst_neo);
  EXPECT_LT(rms, 0.1);  // Yeoh (1993) himself leaves as much at small stretch
  EXPECT_GT(worst_neo, 0.4);
  EXPECT_GT(c[0], 0.1);  // Treloar's own modulus: G = 0.39 MPa, C10 = G/2
  EXPECT_LT(c[0], 0.25);
}

// Ogden's law of three terms fitted to tension, equibiaxial tension and pure shear of the same
// rubber at once, in relative stresses. With the exponents 1.3, 5 and -2 of Ogden (1972) it is
// linear in its moduli.
TEST(FiniteStrain, OgdenFollowsTreloarsRubberInThreeTests) {
  constexpr double kAlpha[3] = {1.3, 5, -2};
  // Incompressible nominal stress of a unit term: 2/alpha (l^(alpha-1) - l3^alpha / l), l3 the
  // thickness.
  const auto unit = [&](double l, double thickness, double alpha) {
    return 2 / alpha * (std::pow(l, alpha) - std::pow(thickness, alpha)) / l;
  };
  struct Loading {
    const char* name;
    const Rows* rows;
    double power;  // thickness = l^power
  };
  const Loading loadings[] = {{"tension", &kTension, -0.5},
                              {"equibiaxial", &kEquibiaxial, -2},
                              {"pure shear", &kPureShear, -1}};
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Loading& t : loadings)
    for (const auto& [stress, l] : *t.rows) {
      Eigen::Vector3d row;
      for (int k = 0; k < 3; ++k) row[k] = unit(l, std::pow(l, t.power), kAlpha[k]) / stress;
      normal += row * row.transpose();
      right += row;
    }
  const Eigen::Vector3d mu = normal.ldlt().solve(right);
  std::printf("Treloar: Ogden mu %.4f, %.3g, %.3g MPa\n", mu[0], mu[1], mu[2]);
  const LawPointer law =
      ogden_law({{mu[0], kAlpha[0]}, {mu[1], kAlpha[1]}, {mu[2], kAlpha[2]}}, 2e5);
  for (const Loading& t : loadings) {
    double squares = 0;
    for (const auto& [stress, l] : *t.rows) {
      const double thickness = std::pow(l, t.power);
      const Vec3 stretch(thickness, 1 / (thickness * l), l);
      // The pressure of the incompressible body makes the thin direction free.
      const Eigen::Matrix3d P = nominal_stress(*law, stretch.asDiagonal());
      const double found = P(2, 2) - P(0, 0) * thickness / l;
      squares += std::pow(found / stress - 1, 2);
    }
    const double rms = std::sqrt(squares / static_cast<double>(t.rows->size()));
    std::printf("Treloar: Ogden, %s, rms %.1f %%\n", t.name, 100 * rms);
    EXPECT_LT(rms, 0.08) << t.name;
  }
}

// Fitted to tension alone, Yeoh's law predicts the other two tests of the same rubber: I1 alone
// tells it of them.
TEST(FiniteStrain, TensionOfTreloarsRubberPredictsTheOtherTests) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(kTension.size()), 3);
  for (std::size_t i = 0; i < kTension.size(); ++i) {
    const auto [stress, l] = kTension[i];
    const double x = l * l + 2 / l - 3, unit = 2 * (l - 1 / (l * l)) / stress;
    A.row(static_cast<Eigen::Index>(i)) << unit, 2 * x * unit, 3 * x * x * unit;
  }
  const Eigen::Vector3d c = A.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(A.rows()));
  const LawPointer law = yeoh_law(c[0], c[1], c[2], 2e5);
  struct Unseen {
    const char* name;
    const Rows* rows;
    double power;  // thickness = l^power
    double limit;
  };
  for (const Unseen& t : {Unseen{"equibiaxial", &kEquibiaxial, -2, 0.25},
                          Unseen{"pure shear", &kPureShear, -1, 0.15}}) {
    double squares = 0, worst = 0;
    for (const auto& [stress, l] : *t.rows) {
      const double thickness = std::pow(l, t.power);
      const Vec3 stretch(thickness, 1 / (thickness * l), l);
      const Eigen::Matrix3d P = nominal_stress(*law, stretch.asDiagonal());
      const double error = (P(2, 2) - P(0, 0) * thickness / l) / stress - 1;
      squares += error * error;
      worst = std::max(worst, std::abs(error));
    }
    const double rms = std::sqrt(squares / static_cast<double>(t.rows->size()));
    std::printf("Treloar: tension predicts %s, rms %.1f %%, worst %.1f %%\n", t.name, 100 * rms,
                100 * worst);
    EXPECT_LT(rms, t.limit) << t.name;
  }
}

}  // namespace
}  // namespace hapsim
