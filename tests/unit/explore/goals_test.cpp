// Goals as they are written, and when they are reached.
#include "explore/goals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Goals, AreWhatTheWordsSay) {
  const Goals goals =
      parse_goals({"E=0.02", "viscoelastic.E1=10%", "lump=2mm", "unseen=2"}, "--goal");
  ASSERT_EQ(goals.errors.size(), 2u);
  EXPECT_EQ(goals.errors[0].parameter, "E");
  EXPECT_DOUBLE_EQ(goals.errors[0].share, 0.02);
  EXPECT_EQ(goals.errors[1].parameter, "viscoelastic.E1");
  EXPECT_DOUBLE_EQ(goals.errors[1].share, 0.1);
  EXPECT_DOUBLE_EQ(goals.lump, 0.002);
  EXPECT_DOUBLE_EQ(goals.unseen.value, 2);
  EXPECT_TRUE(parse_goals({"unseen=5%"}, "--goal").unseen.of_force);
  EXPECT_TRUE(parse_goals({"unseen=1.5"}, "--goal").of_forces());
  EXPECT_TRUE(goals.verdict);  // an error is none of a model that lacks something
  EXPECT_FALSE(parse_goals({"lump=2mm"}, "--goal").of_forces());
  EXPECT_TRUE(parse_goals({"verdict"}, "--goal").of_forces());
}

TEST(Goals, WordsThatAreNoneAreRefused) {
  for (const char* word :
       {"nonsense", "E=", "E=2", "E=0", "E=nan", "E=2%%", "=0.1", "lump=2", "lump=-1mm", "lump=2kg",
        "verdict=1", "unseen", "unseen=1", "unseen=2x", "unseen=inf"})
    EXPECT_EQ(
        error_of([&] { parse_goals({word}, "--goal"); }, ExitCode::kUsage).rfind("--goal: ", 0), 0u)
        << word;
}

TEST(Goals, NamesAreThoseOfEffectsAndAskedForOnce) {
  EXPECT_EQ(parse_goals({"elastic E=2%"}, "--goal").errors[0].parameter, "elastic.E");
  EXPECT_EQ(parse_goals({"verdict", "E=2%", "viscoelastic.E1=5%"}, "--goal").errors.size(), 2u);
  const auto said = [](const std::vector<std::string>& words) {
    return error_of([&] { parse_goals(words, "--goal"); }, ExitCode::kUsage);
  };
  for (const char* word : {"Ee=2%", "elastic.mu=2%", "nonsense.E=2%"})
    EXPECT_NE(said({word}).find("no effect has"), std::string::npos) << word;
  const std::vector<std::vector<std::string>> twice{
      {"E=2%", "E=3%"},         {"E=2%", "elastic.E=3%"}, {"elastic E=2%", "E=2%"},
      {"lump=2mm", "lump=3mm"}, {"unseen=2", "unseen=3"}, {"verdict", "verdict"}};
  for (const auto& words : twice)
    EXPECT_NE(said(words).find("asked for twice"), std::string::npos) << words[0];
}

TEST(Goals, AParameterIsReachedByItsWorstRegion) {
  Model model = test::elastic(1e4, 0.4);
  model.find("elastic", 0, "E")->std_error = 100;
  EXPECT_TRUE(error_state({"E", 0.02}, model, 0.01).reached);
  EXPECT_EQ(error_state({"elastic.E", 0.02}, model, 0.01).name, "elastic E");
  Parameter softer = *model.find("elastic", 0, "E");
  softer.region = 1;
  softer.std_error = 900;
  model.parameters.push_back(softer);
  EXPECT_FALSE(error_state({"E", 0.02}, model, 0.01).reached);
  EXPECT_NEAR(error_state({"E", 0.02}, model, 0.01).value, 0.09, 1e-12);
  EXPECT_EQ(error_state({"E", 0.02}, model, 0.01).region, 1);
  // One that was not estimated is not known, whichever it is.
  model.parameters.back().std_error = std::nan("");
  EXPECT_FALSE(error_state({"E", 0.02}, model, 0.01).reached);
  EXPECT_EQ(error_state({"E", 0.02}, model, 0.01).region, 1);
  std::swap(model.find("elastic", 0, "E")->std_error, model.parameters.back().std_error);
  model.parameters.back().std_error = 10;
  EXPECT_FALSE(error_state({"E", 0.02}, model, 0.01).reached);
  EXPECT_EQ(error_state({"E", 0.02}, model, 0.01).region, 0);
  const std::string said = error_of(
      [&] {
        error_state({"tau1", 0.1}, model, 0.01);
      },
      ExitCode::kUsage);
  EXPECT_NE(said.find("no free parameter tau1"), said.npos) << said;
}

TEST(Goals, AModulusIsNotKnownWhilePoissonsRatioIsAtItsBound) {
  Model model = test::elastic(1e4, 0.4);
  model.find("elastic", 0, "E")->std_error = 100;
  Parameter& nu = *model.find("elastic", 0, "nu");
  nu.std_error = 0.01;
  EXPECT_TRUE(error_state({"E", 0.02}, model, 0.01).reached);
  nu.value = nu.upper;
  nu.std_error = std::nan("");  // as a fit leaves what ends at a bound
  const GoalState state = error_state({"E", 0.02}, model, 0.01);
  EXPECT_FALSE(state.reached);
  EXPECT_FALSE(state.unreachable);
  EXPECT_EQ(state.determine, "elastic nu");
  EXPECT_NE(state.note.find("elastic nu is at its bound"), std::string::npos) << state.note;
  nu.state = ParameterState::kFixed;  // known, then
  EXPECT_TRUE(error_state({"E", 0.02}, model, 0.01).reached);
}

TEST(Goals, NoModulusIsKnownBetterThanAllPlacesErrAlike) {
  Model model = test::elastic(1e4, 0.4);
  model.find("elastic", 0, "E")->std_error = 100;
  model.find("elastic", 0, "nu")->std_error = 0.001;
  EXPECT_TRUE(error_state({"E", 0.005}, model, 0.01).unreachable);
  EXPECT_FALSE(error_state({"E", 0.005}, model, 0.01).reached);
  EXPECT_FALSE(error_state({"E", 0.02}, model, 0.01).unreachable);
  EXPECT_FALSE(error_state({"nu", 0.005}, model, 0.01).unreachable);
  // Said before anything is measured.
  EXPECT_TRUE(hopeless({"E", 0.005}, 0.01).has_value());
  EXPECT_TRUE(hopeless({"elastic.E", 0.005}, 0.01)->unreachable);
  EXPECT_FALSE(hopeless({"E", 0.02}, 0.01).has_value());
  EXPECT_FALSE(hopeless({"nu", 0.005}, 0.01).has_value());
}

TEST(Goals, FewPressesAndWhatIsLeftSettleNothing) {
  Diagnosis d;
  d.verdict = ModelVerdict::kComplete;
  const auto settles = [&](const Coverage& c) {
    EXPECT_EQ(verdict_state(d, c).reached, unsettled(d, c).empty());
    return unsettled(d, c).empty();
  };
  const Coverage enough{kLeastPresses, kSettledPlaces, {}};
  EXPECT_FALSE(settles({kLeastPresses - 1, kSettledPlaces, {}}));
  EXPECT_TRUE(settles(enough));
  d.verdict = ModelVerdict::kIncomplete;
  EXPECT_TRUE(settles(enough));
  d.left.strained = true;
  EXPECT_FALSE(settles(enough));
  d.verdict = ModelVerdict::kAmbiguous;
  EXPECT_FALSE(settles({100, 100, {}}));
}

TEST(Goals, WhatWasNotAskedIsNotSettled) {
  Diagnosis d;
  for (const ModelVerdict verdict : {ModelVerdict::kComplete, ModelVerdict::kIncomplete}) {
    d.verdict = verdict;
    EXPECT_NE(unsettled(d, {30, kSettledPlaces - 1, {}}).find("5 places"), std::string::npos);
    EXPECT_EQ(unsettled(d, {30, 10, {{"no press moves sideways", 1}}}), "no press moves sideways");
  }
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
