// The next presses: those that must tell rivals apart do, and one is picked that sees a parameter.
#include "plan/press_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "effects/catalogue.h"
#include "fit/fit.h"
#include "plan/press_depths.h"
#include "plan/press_paths.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class Plan : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static Model fitted(const Model& start) {
    return fit(start, w(), all_episodes(w().dataset), {0.01, 0.01, true}).model;
  }
  // Chi-square that is left when the model is fitted to forces of the truth along the motion alone,
  // from its own fit to the recording.
  static double left_along(const Recording& motion, const Model& truth, const Model& model) {
    Recording r = motion;
    r.f.assign(r.rows(), Vec3::Zero());
    ExperimentOptions options;
    options.rim_edge = 0.3;
    options.noise = 0.01;
    options.floor = 0.01;
    Experiment next =
        make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), std::move(r), options);
    const Selection all = all_episodes(next.dataset);
    const Eigen::VectorXd f = solved_forces(truth, next, all, false).f;
    Eigen::VectorXd d = f - solved_forces(model, next, all, false).f;
    Weights(next.dataset, all, f, 0.01, 0.01).whiten(d);
    return d.squaredNorm();
  }
};

TEST_F(Plan, AFastPressTellsADamperFromQuickRelaxation) {
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.1});
  test::measure(w(), truth, 0.01, 3);
  const Model relaxing = fitted(truth);
  const Model damped = fitted(test::with(test::elastic(1.5e4, 0.42), "damper", {10}));
  const MeasurementPlan plan = plan_presses({relaxing, damped}, w(), 2);
  ASSERT_EQ(plan.presses.size(), 2u);
  std::printf("%s: %.1f standard deviations\n", plan.presses[0].motion.c_str(), plan.separation);
  EXPECT_NE(plan.presses[0].motion.find("fast"), std::string::npos);
  EXPECT_GT(plan.separation, 5);
  EXPECT_GE(plan.separation, plan.presses[0].separation);
  // What it promises is there: the wrong model fails on the motion by no less.
  EXPECT_GE(left_along(plan.motion, relaxing, damped), 0.9 * plan.separation * plan.separation);
  EXPECT_EQ(plan.parameter, "");
}

TEST_F(Plan, AHeldPressSeesALongTime) {
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 8});
  test::measure(w(), truth, 0.01, 4);
  const MeasurementPlan plan = plan_presses({fitted(truth)}, w(), 1);
  ASSERT_EQ(plan.presses.size(), 1u);
  std::printf("%s: %s, %.2f of its standard error\n", plan.parameter.c_str(),
              plan.presses[0].motion.c_str(), plan.separation);
  EXPECT_EQ(plan.parameter.rfind("viscoelastic", 0), 0u);
  EXPECT_NE(plan.presses[0].motion.find("held"), std::string::npos);
  EXPECT_LT(plan.separation, 0.9);
}

// Two models that differ only in where a boundary runs between the pressed positions.
TEST_F(Plan, WhatLiesBetweenThePressedPlacesIsPressedThere) {
  const auto with_boundary_near = [](double x) {
    Model model = test::elastic(1.5e4, 0.42);
    Parameter stiffer = *model.find("elastic", 0, "E");
    stiffer.region = 1;
    stiffer.value = 3e4;
    model.parameters.insert(model.parameters.begin() + 1, stiffer);
    for (const int region : {0, 1}) {
      for (Parameter row :
           effect_rows(require_effect("regions"), 1, {x + (region == 0 ? -0.01 : 0.01), 0, 0})) {
        if (row.name == "local") continue;
        row.region = region;
        row.state = ParameterState::kFixed;
        model.parameters.push_back(row);
      }
    }
    return model;
  };
  double left = -1, right = 1;  // of the gap in the middle
  for (const Vec3& p : w().dataset.positions) {
    if (p.x() < 0.04) left = std::max(left, p.x());
    if (p.x() >= 0.04) right = std::min(right, p.x());
  }
  const double gap = right - left;
  const std::vector<Model> models{with_boundary_near(left + 0.25 * gap),
                                  with_boundary_near(left + 0.75 * gap)};
  test::measure(w(), models[0], 0.01, 6);
  const MeasurementPlan plan = plan_presses(models, w(), 1);
  ASSERT_EQ(plan.presses.size(), 1u);
  const Vec3 p = plan.presses[0].position;
  std::printf("boundary at x = %.0f or %.0f mm: %s at x = %.0f mm, %.0f standard deviations\n",
              1e3 * (left + 0.25 * gap), 1e3 * (left + 0.75 * gap), plan.presses[0].motion.c_str(),
              1e3 * p.x(), plan.separation);
  EXPECT_GT(p.x(), left);
  EXPECT_LT(p.x(), right);
  for (const Vec3& pressed : w().dataset.positions) EXPECT_GT((pressed - p).norm(), 0.003);
}

TEST_F(Plan, TheMotionIsOneTheToolCanDo) {
  test::measure(w(), test::elastic(1.5e4, 0.42), 0.01, 5);
  const MeasurementPlan plan = plan_presses({fitted(test::elastic(1.5e4, 0.42))}, w(), 3);
  const Recording& m = plan.motion;
  ASSERT_EQ(m.presses().size(), 3u);
  for (const Press& press : m.presses()) {
    EXPECT_TRUE(m.in_air(static_cast<std::size_t>(press.rows.front())));
    EXPECT_TRUE(m.in_air(static_cast<std::size_t>(press.rows.back())));
    for (std::size_t i = 1; i < press.rows.size(); ++i) {
      const double step = m.t[press.rows[i]] - m.t[press.rows[i - 1]];
      EXPECT_GT(step, 0);
      // No jump but the touch itself.
      EXPECT_LT((m.u[press.rows[i]] - m.u[press.rows[i - 1]]).norm(), 0.1 * step);
    }
  }
}

TEST(PlanLines, SayWhatTheMotionIsFor) {
  MeasurementPlan plan;
  plan.presses = {{"fast, held", Vec3(0.01, 0.02, 0.04), 3.5}, {"slow", Vec3(0, 0, 0.04), 0}};
  plan.separation = 4.5;
  EXPECT_EQ(
      plan_lines(plan, "next.csv"),
      (std::vector<std::string>{
          "to tell them apart, record next.csv (4.5 standard deviations of the noise):",
          "  at (10.0, 20.0, 40.0) mm: fast, held (3.5 alone)", "  at (0.0, 0.0, 40.0) mm: slow"}));
  plan.parameter = "elastic nu";
  plan.separation = 0.25;
  EXPECT_EQ(plan_lines(plan, "next.csv")[0],
            "to know elastic nu better, record next.csv (its standard error falls to 25 %):");
}

TEST_F(Plan, OfAParameterOfRegionsTheLeastCertainOneIsDetermined) {
  test::measure(w(), test::elastic(1.5e4, 0.42), 0.01, 3);
  Model two = test::elastic(1.5e4, 0.42);
  Parameter other = *two.find("elastic", 0, "E");
  other.region = 1;
  two.parameters.push_back(other);
  // One of the six places is in region 0.
  int key = 0;
  for (const Vec3& p : w().dataset.positions) {
    ++key;
    for (const auto& [name, value] : {std::pair{"x", p.x()}, std::pair{"y", p.y()}})
      two.parameters.push_back({"regions", key == 1 ? 0 : 1, name + std::to_string(key), value, "m",
                                0, -1, 1, ParameterState::kFixed});
  }
  PlanAsked asked;
  asked.parameter = "elastic E";
  EXPECT_EQ(plan_presses({two}, w(), 1, asked).region, 0);
  asked.region = 1;
  EXPECT_EQ(plan_presses({two}, w(), 1, asked).region, 1);
}

TEST_F(Plan, NoPressGoesDeeperThanItsPlaceAllows) {
  test::measure(w(), test::elastic(1.5e4, 0.42), 0.01, 3);
  const SignedDistance surface(boundary_surface(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1)));
  const double so_far = deepest_so_far(surface, w().dataset.recording);
  const Recording unasked = plan_presses({fitted(test::elastic(1.5e4, 0.42))}, w(), 6).motion;
  for (std::size_t i = 0; i < unasked.rows(); ++i)
    EXPECT_LE(-unasked.u[i].dot(surface.at(unasked.position[i]).normal),
              kDeepestPath * so_far + 1e-12);
  PlanAsked asked;
  asked.depth_at = [](const Vec3& p, const Vec3&) { return p.x() < 0.03 ? 1e-4 : 2e-4; };
  const MeasurementPlan plan = plan_presses({fitted(test::elastic(1.5e4, 0.42))}, w(), 6, asked);
  const Recording& r = plan.motion;
  for (std::size_t i = 0; i < r.rows(); ++i)
    EXPECT_LE(-r.u[i].z(), kDeepestPath * asked.depth_at(r.position[i], {}) + 1e-12);
}

}  // namespace
}  // namespace hapsim
