// Rounds of the loop: presses of another, finer mesh than the one that is asked.
#include "explore/explore.h"

#include <gtest/gtest.h>

#include "expect_error.h"
#include "plan/press_paths.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

ExploreOptions options_for(std::vector<std::string> goals, std::size_t presses) {
  ExploreOptions options;
  options.goals = parse_goals(goals, "--goal");
  options.presses = presses;
  options.experiment.rim_edge = 0.3;
  options.diagnose.flips = 99;
  return options;
}

TetMesh body() {
  return test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
}

Recording nothing() {
  Recording r;
  r.name = "nothing";
  r.metadata.set("tool_radius", "0.004");
  return r;
}

// The motion executed on the true body and added to the recording.
void execute(Recording& so_far, const Recording& motion, const Model& truth, std::uint64_t seed) {
  Recording measured = motion;
  measured.f.assign(measured.rows(), Vec3::Zero());
  ExperimentOptions finer;
  finer.rim_edge = 0.2;
  finer.noise = 0.01;
  finer.floor = 0.01;
  Experiment e = make_experiment(test::block_mesh({0.08, 0.08, 0.04}, 9, 9, 6, 1), measured, finer);
  test::measure(e, e, truth, 0.01, seed);
  measured.f = e.dataset.recording.f;
  so_far.metadata.set("force_noise", "0.01");
  for (std::size_t i = 0; i < measured.rows(); ++i) {
    so_far.line.push_back(static_cast<long>(so_far.rows()) + 2);
    so_far.press.push_back(measured.press[i]);
    so_far.t.push_back(measured.t[i]);
    so_far.position.push_back(measured.position[i]);
    so_far.u.push_back(measured.u[i]);
    so_far.f.push_back(measured.f[i]);
    so_far.contact.push_back(measured.contact[i]);
  }
}

TEST(Explore, TheFirstPressesAreSpread) {
  const Exploration e = explore(body(), {}, {}, nothing(), options_for({"verdict"}, 6));
  EXPECT_EQ(e.aim, Aim::kSpread);
  EXPECT_FALSE(e.reached);
  EXPECT_FALSE(e.diagnosis.has_value());
  ASSERT_EQ(e.plan.presses.size(), 6u);
  for (std::size_t a = 0; a < 6; ++a) {
    const Vec3& p = e.plan.presses[a].position;
    EXPECT_NEAR(p.z(), 0.04, 1e-9);
    EXPECT_GT(std::min({p.x(), p.y(), 0.08 - p.x(), 0.08 - p.y()}), 0.004);
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_GT((e.plan.presses[b].position - p).norm(), 0.015) << a << " and " << b;
  }
}

TEST(Explore, OneByOneIsAsGoodAsABatch) {
  Recording so_far = nothing();
  const Model truth = test::elastic(1.5e4, 0.42);
  for (int k = 0; k < 3; ++k) {
    const Exploration e = explore(body(), {}, {}, so_far, options_for({"verdict"}, 1));
    ASSERT_EQ(e.plan.presses.size(), 1u);
    for (const Vec3& p : so_far.position) EXPECT_GT((e.plan.presses[0].position - p).norm(), 0.015);
    // Numbers and times go on.
    EXPECT_EQ(e.plan.motion.press.front(), k + 1);
    if (k > 0) {
      EXPECT_GT(e.plan.motion.t.front(), so_far.t.back());
    }
    execute(so_far, e.plan.motion, truth, 3);
  }
}

TEST(Explore, AHiddenRelaxationIsNamedAndTheLoopEnds) {
  Recording so_far = nothing();
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {6e3, 0.6});
  const ExploreOptions options = options_for({"verdict", "E=5%"}, 6);
  execute(so_far, explore(body(), {}, {}, so_far, options).plan.motion, truth, 5);
  Exploration e = explore(body(), {}, {}, so_far, options);
  ASSERT_TRUE(e.diagnosis.has_value());
  EXPECT_EQ(e.goals.front().said, "incomplete: viscoelastic");
  EXPECT_TRUE(e.reached);
  EXPECT_TRUE(e.done());
  // What it could not have seen is said.
  EXPECT_GT(e.gap, 0.004);
  EXPECT_GT(e.inside.size(), 2u);
  EXPECT_TRUE(e.plan.presses.empty());
  EXPECT_EQ(e.plan.motion.rows(), 0u);

  // A modulus is never known better than mesh and shape allow: said, and no more is asked for.
  e = explore(body(), {}, {}, so_far, options_for({"E=0.1%"}, 1));
  EXPECT_TRUE(e.ended);
  EXPECT_TRUE(e.goals.back().unreachable);
  EXPECT_TRUE(e.plan.presses.empty());

  // Another parameter is asked for at a new place, until there are too many.
  ExploreOptions more = options_for({"viscoelastic.E1=0.01%"}, 1);
  e = explore(body(), {}, {}, so_far, more);
  EXPECT_EQ(e.aim, Aim::kSharpen);
  EXPECT_EQ(e.parameter, "viscoelastic E1");
  EXPECT_LT(e.promise, 1);
  ASSERT_EQ(e.plan.presses.size(), 1u);
  for (const Vec3& p : so_far.position) EXPECT_GE((e.plan.presses[0].position - p).norm(), 0.004);
  more.most_presses = 6;
  e = explore(body(), {}, {}, so_far, more);
  EXPECT_TRUE(e.ended);
  EXPECT_FALSE(e.reached);
  EXPECT_TRUE(e.plan.presses.empty());
}

TEST(Explore, ALumpIsSeenAndSurrounded) {
  const Vec3 centre(0.050, 0.040, 0.031);
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "inclusion",
                                 {centre.x(), centre.y(), centre.z(), 0.005, 8});
  MeasurementPlan grid;
  for (int k = 0; k < 9; ++k)
    append_press(grid.motion, k + 1, 20.0 * k, 0.05,
                 Vec3(0.02 + 0.02 * (k % 3), 0.02 + 0.02 * (k / 3), 0.04), Vec3::UnitZ(),
                 press_paths(0.002)[3]);
  grid.motion.metadata.set("tool_radius", "0.004");
  Recording so_far = nothing();
  execute(so_far, grid.motion, truth, 7);
  const Exploration e = explore(body(), {}, {}, so_far, options_for({"lump=0.2mm"}, 4));
  EXPECT_FALSE(e.diagnosis.has_value());  // nobody asked for it
  ASSERT_FALSE(e.lumps.empty());
  EXPECT_FALSE(e.reached);
  EXPECT_EQ(e.aim, Aim::kLump);
  ASSERT_EQ(e.plan.presses.size(), 4u);
  // Four presses where they are asked for tell far more than the nine of the grid.
  execute(so_far, e.plan.motion, truth, 8);
  const Exploration after = explore(body(), {}, {}, so_far, options_for({"lump=2mm"}, 4));
  ASSERT_FALSE(after.lumps.empty());
  for (const Exploration* x : {&e, &after})
    std::printf("%zu presses: lump %.1f mm off, within %.1f mm to each side\n", x->presses,
                1e3 * (x->lumps[0].centre - centre).norm(), 1e3 * x->goals[0].value);
  EXPECT_LT(after.goals[0].value, 0.5 * e.goals[0].value);
  EXPECT_LT((after.lumps[0].centre - centre).norm(), 0.004);
}

// Presses of one path at places of a grid.
Recording grid_of(std::size_t path, int side, double apart, int presses) {
  MeasurementPlan grid;
  for (int k = 0; k < presses; ++k)
    append_press(grid.motion, k + 1, 20.0 * k, 0.05,
                 Vec3(0.03 + apart * (k % side), 0.03 + apart * (k / side), 0.04), Vec3::UnitZ(),
                 press_paths(0.002)[path]);
  grid.motion.metadata.set("tool_radius", "0.004");
  return grid.motion;
}

TEST(Explore, SlowPressesAloneSettleNothing) {
  Recording so_far = nothing();
  execute(so_far, grid_of(3, 3, 0.01, 6), test::elastic(1.5e4, 0.42), 4);
  const Exploration e = explore(body(), {}, {}, so_far, options_for({"verdict"}, 3));
  ASSERT_TRUE(e.diagnosis.has_value());
  EXPECT_FALSE(e.reached);
  EXPECT_EQ(e.aim, Aim::kTest);
  ASSERT_EQ(e.plan.presses.size(), 3u);
  EXPECT_NE(e.plan.presses[0].motion.find("sideways"), std::string::npos);
  EXPECT_NE(e.plan.presses[1].motion.find("held"), std::string::npos);
}

TEST(Explore, OnePlaceSettlesNothing) {
  Recording so_far = nothing();
  const Exploration first = explore(body(), {}, {}, so_far, options_for({"verdict"}, 6));
  Recording motion = first.plan.motion;
  motion.position.assign(motion.rows(), Vec3(0.04, 0.04, 0.04));
  execute(so_far, motion, test::elastic(1.5e4, 0.42), 4);
  const Exploration e = explore(body(), {}, {}, so_far, options_for({"verdict"}, 2));
  EXPECT_EQ(e.places, 1u);
  EXPECT_FALSE(e.reached);
  EXPECT_FALSE(e.ended);
  ASSERT_EQ(e.plan.presses.size(), 2u);
  for (const PlannedPress& p : e.plan.presses)
    EXPECT_GE((p.position - Vec3(0.04, 0.04, 0.04)).norm(), 0.004);
}

TEST(Explore, WithNoPlaceLeftTheLoopEnds) {
  Recording so_far = nothing();
  const Recording pressed = grid_of(3, 1, 0.01, 1);
  execute(so_far, pressed, test::elastic(1.5e4, 0.42), 4);
  so_far.metadata.set("tool_radius", "0.028");  // none fits that far away from the place
  const Exploration e = explore(body(), {}, {}, so_far, options_for({"verdict"}, 2));
  EXPECT_TRUE(e.ended);
  EXPECT_FALSE(e.reached);
  EXPECT_NE(e.why.find("no place is left"), std::string::npos) << e.why;
}

TEST(Explore, NoMotionHasMorePressesThanAreLeft) {
  ExploreOptions options = options_for({"verdict"}, 6);
  options.most_presses = 2;
  EXPECT_EQ(explore(body(), {}, {}, nothing(), options).plan.presses.size(), 2u);
}

TEST(Explore, AContactOffTheBodyIsRefusedAtOnce) {
  Recording so_far = grid_of(3, 1, 0.01, 1);
  so_far.name = "data.csv";
  so_far.f.assign(so_far.rows(), Vec3::Zero());
  for (Vec3& p : so_far.position) p.z() += 0.05;
  const std::string said =
      error_of([&] { explore(body(), {}, {}, so_far, options_for({"verdict"}, 1)); });
  EXPECT_NE(said.find("0.05 m off the body's surface"), said.npos) << said;
}

TEST(Explore, WithoutTimesAStepIsTheUsual) {
  Recording so_far = nothing();
  Recording motion = explore(body(), {}, {}, so_far, options_for({"verdict"}, 6)).plan.motion;
  motion.position.assign(motion.rows(), Vec3(0.04, 0.04, 0.04));
  execute(so_far, motion, test::elastic(1.5e4, 0.42), 3);
  so_far.t.clear();
  const Exploration e = explore(body(), {}, {}, so_far, options_for({"verdict"}, 1));
  EXPECT_TRUE(e.no_times);
  EXPECT_TRUE(e.diagnosis.has_value());
  ASSERT_GT(e.plan.motion.rows(), 2u);
  EXPECT_NEAR(e.plan.motion.t[1] - e.plan.motion.t[0], 0.02, 1e-9);
}

TEST(Explore, ABodyThatNowhereLooksUpIsRefused) {
  ExploreOptions options = options_for({"verdict"}, 1);
  Recording wide = nothing();
  wide.metadata.set("tool_radius", "0.05");
  const std::string said = error_of([&] { explore(body(), {}, {}, wide, options); });
  EXPECT_NE(said.find("no place is left"), said.npos) << said;
}

}  // namespace
}  // namespace hapsim
