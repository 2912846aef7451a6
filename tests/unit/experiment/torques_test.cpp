// Levers and torques of a model: their derivatives, and what else torques may show.
#include "experiment/torques.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/synthetic.h"

namespace hapsim {
namespace {

MaterialSpec two_regions(double left, double right, double nu) {
  MaterialSpec material;
  material.nu = nu;
  material.nu_column = 2;
  material.modulus = {left, right};
  material.modulus_column = {0, 1};
  material.key_point = {Vec3(0.02, 0.04, 0), Vec3(0.06, 0.04, 0)};
  material.key_region = {0, 1};
  return material;
}

const Eigen::Matrix3d& by(const TorqueLever& lever, int column) {
  for (const auto& [c, slope] : lever.by_column)
    if (c == column) return slope;
  throw std::logic_error("no such column");
}

TEST(Torques, LeversHaveTheirDerivatives) {
  const Experiment w = test::experiment();
  MaterialSpec one;
  one.nu = 0.4;
  one.nu_column = 0;
  one.modulus = {1e4};
  one.modulus_column = {1};
  const TorqueLevers levers(w.places, one, true);
  const auto at_nu = [&](double nu) {
    MaterialSpec other = one;
    other.nu = nu;
    return levers.at(3, other).L;
  };
  const double step = 1e-4;
  const Eigen::Matrix3d slope = (at_nu(0.4 + step) - at_nu(0.4 - step)) / (2 * step);
  EXPECT_LT((by(levers.at(3, one), 0) - slope).norm(), 1e-5 * slope.norm());
  one.modulus = {3e5};
  EXPECT_LT((levers.at(3, one).L - at_nu(0.4)).norm(), 1e-14);
  EXPECT_LT(levers.at(3, one).doubt, 0.05 * 0.004);
}

// A region beside the tool pulls the resistance to its side; a common factor does nothing.
TEST(Torques, RegionsMoveTheLever) {
  const Experiment w = test::experiment();
  const MaterialSpec alike = two_regions(1e4, 1e4, 0.4), apart = two_regions(1e4, 4e4, 0.4);
  const TorqueLevers levers(w.places, apart, true);
  const TorqueLever lever = levers.at(1, apart);  // at x = 0.04, on the border
  const Eigen::Matrix3d even = TorqueLevers(w.places, alike, false).at(1, alike).L;
  EXPECT_GT(std::abs(lever.L(1, 2) - even(1, 2)), 0.2 * 0.004);
  // More resistance at larger x: the force up on the tool acts there, a moment about -y.
  EXPECT_LT(lever.L(1, 2), even(1, 2));
  const auto L = [&](double left, double right) {
    return levers.at(1, two_regions(left, right, 0.4)).L;
  };
  EXPECT_LT((L(2e4, 8e4) - lever.L).norm(), 1e-12);
  const double step = 10;
  const Eigen::Matrix3d slope = (L(1e4, 4e4 + step) - L(1e4, 4e4 - step)) / (2 * step);
  EXPECT_LT((by(lever, 1) - slope).norm(), 1e-5 * slope.norm());
}

TEST(Torques, HaveTheDerivativesOfForceAndLever) {
  const Experiment w = test::experiment();
  const Selection all = all_episodes(w.dataset);
  const Model model = test::elastic(2e4, 0.4);
  const TorqueLevers levers(w.places, material_of(model), true);
  const auto torques = [&](const Model& m, bool derivatives) {
    const Linearisation about = w.places.solve(material_of(m));
    return model_torques(forces_before_sensor(m, w, about, all, derivatives), w.dataset, levers,
                         material_of(m), all);
  };
  const Signal at = torques(model, true);
  for (std::size_t k = 0; k < 2; ++k) {
    Model up = model, down = model;
    const double step = k == 0 ? 1 : 1e-5;
    up.parameters[k].value += step;
    down.parameters[k].value -= step;
    const Eigen::VectorXd slope = (torques(up, false).f - torques(down, false).f) / (2 * step);
    EXPECT_LT((at.df.col(static_cast<Eigen::Index>(k)) - slope).norm(), 1e-5 * slope.norm());
  }
}

TEST(Torques, ShowATipElsewhere) {
  Random random(2);
  const Vec3 offset(1e-3, -4e-4, 2e-4);
  Eigen::VectorXd force(300), residual(300);
  for (Eigen::Index i = 0; i < 300; i += 3) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    const Vec3 f(0.3 * x, 0.3 * y, 1 + 0.3 * z);
    force.segment<3>(i) = f;
    const double a = random.normal(), b = random.normal(), c = random.normal();
    residual.segment<3>(i) = offset.cross(f) + 1e-5 * Vec3(a, b, c);
  }
  const TorquePole pole = torque_pole(residual, force, 1e-5);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(pole.offset[k], offset[k], 4 * pole.std_error[k]);
    EXPECT_LT(pole.std_error[k], 1e-5);
  }
  EXPECT_LT(pole.rms_after, 1.2e-5);
}

TEST(Torques, OfWhatHasNoLeverAreRefused) {
  const Experiment w = test::experiment();
  const Model model = test::elastic(2e4, 0.4);
  EXPECT_EQ(torque_refusal(model, w.dataset), "");
  // At their starts: at identity a law may be left out.
  const auto more = [&](const char* name) {
    const Effect& effect = *find_effect(name);
    std::vector<double> values;
    for (const ParameterCard& p : effect.card().parameters) values.push_back(p.start);
    return test::with(model, name, values);
  };
  for (const char* name : {"friction", "tip", "layer", "hyperelastic", "damper", "sensor-lag",
                           "filter", "sensor-rotation", "sensor-gain"})
    EXPECT_NE(torque_refusal(more(name), w.dataset).find(name), std::string::npos) << name;
  for (const char* name : {"viscoelastic", "sensor-bias", "sensor-drift", "tare", "temperature"})
    EXPECT_EQ(torque_refusal(more(name), w.dataset), "") << name;
}

}  // namespace
}  // namespace hapsim
