// One material pressed on two bodies and by two tools, fitted together: the forces come from meshes
// with two thirds of every length of the model's.
#include <gtest/gtest.h>

#include <cmath>

#include "experiment/experiment.h"
#include "fit/extend.h"
#include "support/block_mesh.h"
#include "support/finer_contact.h"
#include "support/objects.h"

namespace hapsim {
namespace {

constexpr double kModulus = 1.5e4, kPoisson = 0.42, kFiner = 1.5;

struct Pressed {
  Recording recording;
  std::vector<Setup> setup_of_row;
};

// Normal presses of 2 mm at a place, with the scatter of `noise` of the peak.
void press(Pressed& all, const ContactBase& truth, const Setup& setup, const Vec3& place,
           double noise, Random& random) {
  Material material;
  material.nu = kPoisson;
  const Eigen::Matrix3d K =
      test::finer_stiffness(truth, {place}, setup.tool_radius, material, kFiner).front();
  Recording& r = all.recording;
  const int number = r.press.empty() ? 0 : r.press.back() + 1;
  const Vec3 deepest(0, 0, -2e-3);
  const double scatter = noise * kModulus * (K * deepest).norm();
  for (int i = 1; i <= 20; ++i) {
    r.line.push_back(static_cast<long>(r.line.size()) + 2);
    r.press.push_back(number);
    r.position.push_back(place);
    r.u.push_back(i / 20.0 * deepest);
    r.f.push_back(-kModulus * K * r.u.back());
    for (int k = 0; k < 3; ++k) r.f.back()[k] += scatter * random.normal();
    all.setup_of_row.push_back(setup);
  }
}

Fit fitted(const std::vector<TetMesh>& bodies, const Pressed& pressed, double floor) {
  ExperimentOptions options;
  options.noise = 5e-4;
  options.floor = floor;
  const Experiment w =
      make_experiment(bodies, make_dataset(pressed.recording, pressed.setup_of_row), options);
  EXPECT_EQ(w.dataset.positions.size(), w.dataset.setups.size());
  const Selection all = all_episodes(w.dataset);
  return fit(elastic_model(w, all), w, all, {w.noise.value, w.floor, true});
}

TEST(Together, TwoToolsTellPoissonsRatioWhereOneCannot) {
  const TetMesh exact = test::block_mesh({0.06, 0.06, 0.02}, 12, 12, 4, 1);
  const std::vector<TetMesh> bodies{make_body_mesh(boundary_surface(exact), {}, "block")};
  const ContactBase truth = test::finer_base(exact, kFiner);
  Random random(3);
  Pressed one, two;
  press(two, truth, {0, 0.003}, {0.03, 0.03, 0.02}, 0.002, random);
  one = two;
  press(two, truth, {0, 0.009}, {0.03, 0.03, 0.02}, 0.002, random);
  one.recording.name = two.recording.name = "block";
  const Fit by_one = fitted(bodies, one, 0.01), by_two = fitted(bodies, two, 0.01);
  const Parameter& nu = *by_two.model.find("elastic", 0, "nu");
  const Parameter& alone = *by_one.model.find("elastic", 0, "nu");
  EXPECT_TRUE(by_two.converged);
  EXPECT_NEAR(nu.value, kPoisson, 0.03);
  EXPECT_NEAR(by_two.model.find("elastic", 0, "E")->value, kModulus, 0.03 * kModulus);
  EXPECT_LT(nu.std_error, 0.05);
  // NaN: not to be told at all.
  EXPECT_FALSE(alone.std_error < 5 * nu.std_error) << alone.std_error << " " << nu.std_error;
  std::printf("nu %.4f +- %.4f by one tool, %.4f +- %.4f by two\n", alone.value, alone.std_error,
              nu.value, nu.std_error);
}

TEST(Together, TwoBodiesOfOneMaterial) {
  BodyOptions as_it_is;
  as_it_is.preserve_surface = true;
  const std::vector<TetMesh> exact{test::block_mesh({0.06, 0.06, 0.02}, 12, 12, 4, 1),
                                   make_body_mesh(test::half_ball(20), as_it_is, "ball")};
  std::vector<TetMesh> bodies;
  Pressed pressed;
  Random random(4);
  const Vec3 places[] = {{0.03, 0.03, 0.02}, {0, 0, 0.05}};
  for (int b = 0; b < 2; ++b) {
    bodies.push_back(make_body_mesh(boundary_surface(exact[b]), {}, "body"));
    press(pressed, test::finer_base(exact[b], kFiner), {b, 0.006}, places[b], 0.002, random);
  }
  pressed.recording.name = "bodies";
  const Fit result = fitted(bodies, pressed, 0.01);
  EXPECT_TRUE(result.converged);
  const Parameter& e = *result.model.find("elastic", 0, "E");
  const Parameter& nu = *result.model.find("elastic", 0, "nu");
  EXPECT_NEAR(e.value, kModulus, 3 * e.std_error);
  EXPECT_NEAR(nu.value, kPoisson, 3 * nu.std_error);
  EXPECT_NEAR(e.value, kModulus, 0.05 * kModulus);
  std::printf("E %.0f +- %.0f, nu %.4f +- %.4f\n", e.value, e.std_error, nu.value, nu.std_error);
}

}  // namespace
}  // namespace hapsim
