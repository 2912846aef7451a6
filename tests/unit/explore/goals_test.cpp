// Goals as they are written, and when they are reached.
#include "explore/goals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Goals, AreWhatTheWordsSay) {
  const Goals goals = parse_goals({"E=0.02", "viscoelastic.E1=10%", "lump=2mm"}, "--goal");
  ASSERT_EQ(goals.errors.size(), 2u);
  EXPECT_EQ(goals.errors[0].parameter, "E");
  EXPECT_DOUBLE_EQ(goals.errors[0].share, 0.02);
  EXPECT_EQ(goals.errors[1].parameter, "viscoelastic.E1");
  EXPECT_DOUBLE_EQ(goals.errors[1].share, 0.1);
  EXPECT_DOUBLE_EQ(goals.lump, 0.002);
  EXPECT_TRUE(goals.verdict);  // an error is none of a model that lacks something
  EXPECT_FALSE(parse_goals({"lump=2mm"}, "--goal").of_forces());
  EXPECT_TRUE(parse_goals({"verdict"}, "--goal").of_forces());
}

TEST(Goals, WordsThatAreNoneAreRefused) {
  for (const char* word : {"nonsense", "E=", "E=2", "E=0", "E=nan", "E=2%%", "=0.1", "lump=2",
                           "lump=-1mm", "lump=2kg", "verdict=1"})
    EXPECT_EQ(
        error_of([&] { parse_goals({word}, "--goal"); }, ExitCode::kUsage).rfind("--goal: ", 0), 0u)
        << word;
}

TEST(Goals, AParameterIsReachedByItsWorstRegion) {
  Model model = test::elastic(1e4, 0.4);
  model.find("elastic", 0, "E")->std_error = 100;
  EXPECT_TRUE(error_state({"E", 0.02}, model).reached);
  EXPECT_EQ(error_state({"elastic.E", 0.02}, model).name, "elastic E");
  Parameter softer = *model.find("elastic", 0, "E");
  softer.region = 1;
  softer.std_error = 900;
  model.parameters.push_back(softer);
  EXPECT_FALSE(error_state({"E", 0.02}, model).reached);
  EXPECT_NEAR(error_state({"E", 0.02}, model).value, 0.09, 1e-12);
  // One that was not estimated is not known.
  model.parameters.back().std_error = std::nan("");
  EXPECT_FALSE(error_state({"E", 0.02}, model).reached);
  const std::string said = error_of([&] { error_state({"tau1", 0.1}, model); }, ExitCode::kUsage);
  EXPECT_NE(said.find("no free parameter tau1"), said.npos) << said;
}

TEST(Goals, FewPressesAndWhatIsLeftSettleNothing) {
  Diagnosis d;
  d.verdict = ModelVerdict::kComplete;
  EXPECT_FALSE(settles(d, kLeastPresses - 1));
  EXPECT_TRUE(settles(d, kLeastPresses));
  d.verdict = ModelVerdict::kIncomplete;
  EXPECT_TRUE(settles(d, kLeastPresses));
  d.left.strained = true;
  EXPECT_FALSE(settles(d, kLeastPresses));
  d.verdict = ModelVerdict::kAmbiguous;
  EXPECT_FALSE(settles(d, 100));
}

TEST(Goals, ALumpMustLieWithinItsWidestInterval) {
  StiffnessImage image;
  EXPECT_FALSE(lump_state(0.002, image).reached);
  Lump lump;
  lump.x = {0.010, 0.012};
  lump.y = {0.020, 0.023};
  lump.z = {0.015, 0.018};
  image.lumps = {lump};
  EXPECT_TRUE(lump_state(0.002, image).reached);
  EXPECT_FALSE(lump_state(0.001, image).reached);
  EXPECT_NEAR(lump_state(0.001, image).value, 0.0015, 1e-12);
}

}  // namespace
}  // namespace hapsim
