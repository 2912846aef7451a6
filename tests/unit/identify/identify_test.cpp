#include "identify/identify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expect_error.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

struct Lab {
  TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
  Experiment w = test::experiment();
  ExperimentOptions options;
  IdentifyRequest request;

  Lab() {
    test::measure(w, test::elastic(12000, 0.4), 0.01, 3);
    request.fit.fix = {"nu=0.4"};
  }
  Identification found() { return identify(request, body, w, options); }
};

TEST(Identify, TheModelSaysWhatItWasFittedTo) {
  Lab lab;
  const Identification found = lab.found();
  const Model& model = found.fitted.model;
  EXPECT_NEAR(model.find("elastic", 0, "E")->value, 12000, 60);
  EXPECT_EQ(found.unseen_by, "positions");
  EXPECT_NEAR(found.unseen, 0.01, 0.002);
  EXPECT_EQ(model.metadata.find("heldout_by"), "positions");
  EXPECT_EQ(found.cut_short, "");
  EXPECT_FALSE(identification_summary(found, lab.w).verdict.empty());
}

TEST(Identify, WhatIsInterruptedSaysSo) {
  Lab lab;
  lab.request.interrupted = [] { return true; };
  lab.request.end = [] { return true; };
  const Identification found = lab.found();
  EXPECT_EQ(found.cut_short, "the error on unseen data was found");
  EXPECT_TRUE(std::isnan(found.unseen));
  EXPECT_TRUE(found.fitted.model.metadata.find("interrupted").has_value());
}

TEST(Identify, AFitThatIsStoppedIsTheBestSoFar) {
  Lab lab;
  lab.request.fit.fix = {};  // one modulus alone would be found at once
  lab.request.options.watch = [](const FitProgress&) { return false; };
  EXPECT_TRUE(lab.found().fitted.stopped);
}

TEST(Identify, WhoIsAskedMayRefuseAndRefine) {
  Lab lab;
  std::size_t starts = 0;
  lab.request.folds = 0;
  lab.request.starts = [&](std::vector<Model>& models) { starts = models.size(); };
  lab.request.refine = [](const Fit& fitted) {
    Fit other = fitted;
    other.model.find("elastic", 0, "E")->value = 1;
    return other;
  };
  const Identification found = lab.found();
  EXPECT_EQ(starts, 1u);
  EXPECT_EQ(found.fitted.model.find("elastic", 0, "E")->value, 1);
  EXPECT_TRUE(std::isnan(found.unseen));
  lab.request.options.profile = true;
  lab.request.options.robust = RobustLoss::kHuber;
  EXPECT_NE(error_of([&] { lab.found(); }, ExitCode::kUsage), "");
}

TEST(GivenRecordings, ThereIsOneBodyOrOneForEach) {
  require_bodies_for(1, 3);
  require_bodies_for(3, 3);
  EXPECT_EQ(error_of([] { require_bodies_for(2, 3); }, ExitCode::kUsage).substr(0, 25),
            "2 bodies for 3 recordings");
}

TEST(GivenRecordings, PressesOfSeveralAreOne) {
  GivenRecordings given;
  given.bodies = {test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1)};
  Recording one = test::presses();
  for (std::size_t i = 0; i < one.rows(); ++i) one.f[i] = -100 * one.u[i];
  join_given(given, {0, 0}, {one, one}, {});
  EXPECT_EQ(given.setup_of_row.size(), 2 * one.rows());
  EXPECT_EQ(given.dataset.rows(), 2 * one.rows());
  EXPECT_EQ(given.dataset.bodies(), 1u);
}

}  // namespace
}  // namespace hapsim
