// The next presses: those that must tell rivals apart do, and one is picked that sees a parameter.
#include "diagnose/plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class Plan : public ::testing::Test {
 protected:
  static Workspace& w() {
    static Workspace workspace = test::workspace();
    return workspace;
  }
  static Model fitted(const Model& start) {
    return fit(start, w().dataset, all_episodes(w().dataset), *w().body, {0.01, 0.01, true}).model;
  }
  // Chi-square that is left when the model is fitted to forces of the truth along the motion alone,
  // from its own fit to the recording.
  static double left_along(const Recording& motion, const Model& truth, const Model& model) {
    Recording r = motion;
    r.f.assign(r.rows(), Vec3::Zero());
    WorkspaceOptions options;
    options.rim_edge = 0.3;
    options.noise = 0.01;
    options.floor = 0.01;
    Workspace next =
        make_workspace(test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1), std::move(r), options);
    const Selection all = all_episodes(next.dataset);
    const Eigen::VectorXd f = model_forces(truth, next.dataset, all, *next.body, false).f;
    Eigen::VectorXd d = f - model_forces(model, next.dataset, all, *next.body, false).f;
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

}  // namespace
}  // namespace hapsim
