// Displacements of given forces: the inverse of the forces of given displacements, and creep.
#include "simulate/traction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "simulate/simulate.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kE = 2e4, kE1 = 8e3, kTau = 0.3;

void add(Model& model, const std::string& name, const std::vector<double>& values) {
  for (const Effect* effect : catalogue())
    if (effect->card().name == name) {
      const auto rows = effect_rows(*effect, 1, values);
      model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
    }
}

Model sliding_model(bool relaxes) {
  Model model;
  add(model, "elastic", {kE, 0.4});
  if (relaxes) add(model, "viscoelastic", {kE1, kTau});
  return model;
}

Eigen::Matrix3d stiffness() {
  return (Eigen::Matrix3d() << 90, 5, -8, 5, 110, 3, -8, 3, 200).finished();
}

double worst_return(const Model& model, const StiffnessAt& at) {
  const Dataset given = make_dataset(test::presses());
  const Selection all = all_episodes(given);
  Dataset forced = given;
  forced.recording = with_forces(given, all, model_forces(model, given, at, all, false).f);
  const std::vector<Vec3> u = displacements_of_forces(model, forced, at);
  double worst = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!given.recording.in_air(i)) worst = std::max(worst, (u[i] - given.recording.u[i]).norm());
  return worst;
}

TEST(Traction, FindsTheMotionThatMadeTheForces) {
  PositionStiffness plain;
  plain.K = stiffness();
  PositionStiffness regional = plain;
  regional.relaxing = {{0.4 * stiffness(), 0.1}, {Vec3(20, 5, 60).asDiagonal(), 2}};
  EXPECT_LT(worst_return(sliding_model(false), [&](std::size_t) { return plain; }), 1e-15);
  EXPECT_LT(worst_return(sliding_model(true), [&](std::size_t) { return plain; }), 1e-14);
  EXPECT_LT(worst_return(sliding_model(false), [&](std::size_t) { return regional; }), 1e-14);
}

// A force that stays from t = 0 on: u = (1/E - E1 exp(-t E / (tau (E + E1))) / (E (E + E1))) F,
// in units of the stiffness over E. Motion is taken as straight between samples, so the error falls
// with the square of their step.
TEST(Traction, CreepsAsTheStandardSolid) {
  double before = 0;
  for (const double step : {0.04, 0.02, 0.01}) {
    Recording r;
    r.metadata.set("tool_radius", "0.004");
    for (int i = 0; i * step <= 1 + 1e-9; ++i) {
      r.line.push_back(i + 2);
      r.press.push_back(1);
      r.t.push_back(i * step);
      r.position.push_back(Vec3::Zero());
      r.u.push_back(Vec3::Zero());
      r.f.emplace_back(0, 0, 1);
    }
    PositionStiffness s;
    s.K = kE * Eigen::Matrix3d::Identity();
    const std::vector<Vec3> u = displacements_of_forces(sliding_model(true), make_dataset(r),
                                                        [&](std::size_t) { return s; });
    double worst = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double left = kE1 * std::exp(-r.t[i] * kE / (kTau * (kE + kE1))) / (kE + kE1);
      worst = std::max(worst, std::abs(-u[i].z() * kE - (1 - left)));
    }
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / worst), 2, 0.1);
    }
    before = worst;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Traction, RefusesWhatIsNotLinear) {
  Model model = sliding_model(false);
  add(model, "sensor-bias", {0.1, 0, 0});
  PositionStiffness s;
  s.K = stiffness();
  Recording r = test::presses();
  for (std::size_t i = 0; i < r.rows(); ++i)
    r.f[i] = Vec3(0, 0, 0.1 * std::sin(0.1 * static_cast<double>(i)));
  EXPECT_THROW(displacements_of_forces(model, make_dataset(r), [&](std::size_t) { return s; }),
               Error);
  Model damped = sliding_model(false);
  add(damped, "damper", {1});
  EXPECT_THROW(with_displacements(damped, make_dataset(r), [&](std::size_t) { return s; }), Error);
}

}  // namespace
}  // namespace hapsim
