// A field learned from places foretells those that were left out, within its band.
#include "fit/learned_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/fit.h"
#include "io/stream.h"
#include "model/body_parameters.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kDepth = 2e-3;

// A smooth change of stiffness by a factor of four over the block, with a power of the depth whose
// mean over the places is kMeanPower.
constexpr double kMeanPower = 0.3;
double log_factor(const Vec3& p) {
  return 0.7 * std::sin(70 * p.x()) * std::cos(60 * p.y());
}
double power(const Vec3& p) {
  constexpr double kMean = -0.2262;  // of the first term
  return kMeanPower + 0.4 * std::cos(50 * p.x() + 20 * p.y()) - kMean;
}

Recording many_presses() {
  Recording r;
  r.name = "many";
  r.metadata.set("tool_radius", "0.003");
  int press = 0;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 6; ++j, ++press)
      for (int k = 1; k <= 8; ++k) {
        r.line.push_back(static_cast<long>(r.line.size()) + 2);
        r.press.push_back(press);
        r.position.emplace_back(0.013 + 0.009 * i + 0.001 * (j % 2), 0.013 + 0.0105 * j, 0.04);
        r.u.emplace_back(0, 0, -kDepth * k / 8);
        r.f.push_back(Vec3::Zero());
      }
  return r;
}

class LearnedField : public ::testing::Test {
 protected:
  static constexpr double kNoise = 2e-3;
  static Experiment& w() {
    static Experiment experiment = [] {
      ExperimentOptions options;
      options.rim_edge = 0.35;
      options.noise = kNoise;
      options.floor = 0.01;
      options.nu_low = options.nu_high = 0.4;
      return make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), many_presses(),
                             options);
    }();
    return experiment;
  }
  static Model elastic() {
    Model model = test::elastic(1e4, 0.4);
    poissons_ratio_of(model)->state = ParameterState::kFixed;
    return model;
  }
  static void measure() {
    const Selection all = all_episodes(w().dataset);
    const Eigen::VectorXd f = solved_forces(elastic(), w(), all, false).f;
    Random random(11);
    for (std::size_t row = 0; row < w().dataset.rows(); ++row) {
      const Vec3& p = w().dataset.recording.position[row];
      const double d = w().dataset.recording.u[row].norm();
      const double factor = std::exp(log_factor(p) + power(p) * std::log(d / kDepth));
      for (int k = 0; k < 3; ++k)
        w().dataset.recording.f[row][k] =
            factor * f[3 * static_cast<Eigen::Index>(row) + k] + kNoise * random.normal();
    }
  }
  static Model with_field() {
    Model model = elastic();
    for (const Parameter& p : effect_rows(field_effect(), 1, {})) model.parameters.push_back(p);
    return model;
  }
};

TEST_F(LearnedField, ForetellsPlacesLeftOutWithinItsBand) {
  measure();
  const Folds folds = make_folds(w().dataset, 6);
  const FitOptions options{kNoise, 0.01, true};
  const auto held_out = [&](const Model& model) {
    return held_out_error(
               [&](const Selection&) {
                 return Starts{{model}, {}};
               },
               w(), folds, options)
        .error.pooled;
  };
  const double without = held_out(elastic()), with = held_out(with_field());
  std::printf("places left out: %.2f mN without the field, %.2f with it\n", 1e3 * without,
              1e3 * with);
  EXPECT_LT(with, 0.25 * without);

  int inside = 0, counted = 0;
  for (const Selection& left_out : folds.held_out) {
    Selection rest;
    for (const int e : all_episodes(w().dataset))
      if (std::find(left_out.begin(), left_out.end(), e) == left_out.end()) rest.push_back(e);
    const Fit fitted = fit(with_field(), w(), rest, options);
    ASSERT_TRUE(fitted.converged);
    const PlaceField field = place_field(fitted.model);
    EXPECT_EQ(field.place.size(), rest.size());
    const double modulus = modulus_of(fitted.model)->value;
    std::vector<Vec3> places;
    for (const int e : left_out)
      places.push_back(w().dataset.positions[static_cast<std::size_t>(
          w().dataset.episodes[static_cast<std::size_t>(e)].position)]);
    const std::vector<FieldAt> told = field_at(field, places);
    for (std::size_t p = 0; p < places.size(); ++p, ++counted) {
      const double truth =
          log_factor(places[p]) + power(places[p]) * std::log(field.depth / kDepth);
      const double error = std::log(modulus / 1e4) + told[p].log_factor - truth;
      inside += std::abs(error) < 1.96 * told[p].log_factor_sd;
    }
  }
  std::printf("95 %% bands hold %d of %d places\n", inside, counted);
  EXPECT_GE(inside, 0.85 * counted);
}

// Under a ball the body sees another depth than the recording's.
TEST_F(LearnedField, TakesTheDepthThatTheBodySees) {
  const Selection all = all_episodes(w().dataset);
  Model ball = elastic();
  for (Parameter p : effect_rows(require_effect("tip"), 1, {300})) {
    p.state = ParameterState::kFixed;
    ball.parameters.push_back(p);
  }
  const Linearisation about = w().places.solve(material_of(ball));
  const Eigen::VectorXd f = model_forces(ball, w(), about, all, false).f;
  const std::vector<Vec3> motion = motion_on_body(ball, w(), about, all);
  Random random(12);
  for (std::size_t row = 0; row < w().dataset.rows(); ++row) {
    const Vec3& p = w().dataset.recording.position[row];
    const double factor =
        std::exp(log_factor(p) + power(p) * std::log(motion[row].norm() / kDepth));
    for (int k = 0; k < 3; ++k)
      w().dataset.recording.f[row][k] =
          factor * f[3 * static_cast<Eigen::Index>(row) + k] + kNoise * random.normal();
  }
  Model model = ball;
  for (const Parameter& p : effect_rows(field_effect(), 1, {})) model.parameters.push_back(p);
  const Fit fitted = fit(model, w(), all, {kNoise, 0.01, true});
  EXPECT_LT(fitted.error.pooled, 1.1 * kNoise);
  measure();
}

TEST_F(LearnedField, IsInTheModelFile) {
  measure();
  const Fit fitted = fit(with_field(), w(), all_episodes(w().dataset), {kNoise, 0.01, true});
  std::stringstream file;
  write_model(file, fitted.model);
  Input input = Input::from_bytes(file.str(), "model.csv");
  const Model again = read_model(input);
  const Selection all = all_episodes(w().dataset);
  EXPECT_LT(
      (solved_forces(again, w(), all, false).f - solved_forces(fitted.model, w(), all, false).f)
          .norm(),
      1e-9);
  EXPECT_LT(fitted.error.pooled, 1.1 * kNoise);
  EXPECT_NEAR(place_field(again).mean_power, kMeanPower, 0.02);

  Model cut = fitted.model;
  cut.parameters.pop_back();
  std::stringstream lacking;
  write_model(lacking, cut);
  Input short_input = Input::from_bytes(lacking.str(), "model.csv");
  EXPECT_THROW(read_model(short_input), Error);
}

TEST_F(LearnedField, IsForgottenBeforeItIsLearnedAnew) {
  measure();
  Model model = fit(with_field(), w(), all_episodes(w().dataset), {kNoise, 0.01, true}).model;
  ASSERT_TRUE(learns_field(model));
  forget_field(model);
  const PlaceField field = place_field(model);
  EXPECT_EQ(field.place.size(), 1);
  EXPECT_EQ(field.at({0.03, 0.03, 0.04})[0], 0);
}

}  // namespace
}  // namespace hapsim
