// What else is missing tells rivals apart, or is told beside them.
#include "diagnose/beside_rivals.h"

#include <gtest/gtest.h>

#include "effects/catalogue.h"
#include "model/model_edit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

const std::string kBias = "sensor-bias";

struct Ended {
  Baseline base;
  Diagnosis d;
  BesideRivals found;
  std::vector<std::string> rivals() const {
    std::vector<std::string> names{found.ends.findings[found.best].effect};
    for (const std::size_t k : found.rivals) names.push_back(found.ends.findings[k].effect);
    return names;
  }
};

// Two rivals that passed, and a search that goes on with the sensor's offset.
Ended go_on_beside(const Model& truth, const std::string& a, const std::string& b) {
  Experiment w = test::experiment();
  test::measure_finer(w, truth, 0.01, 3);
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  Ended ended;
  ended.base = make_baseline(test::elastic(1.5e4, 0.42), ground, folds);
  Round round;
  std::string lack;
  for (const std::string& name : {a, b}) {
    round.candidates.push_back(*try_effect(require_effect(name), ended.base, ground, lack));
    Finding f;
    f.effect = name;
    f.p_value = 0;
    f.share = 1;
    f.held_out_now = ended.base.held_out.error;
    round.findings.push_back(f);
  }
  const auto with_bias = [&](Branch& branch) {
    branch.base = make_baseline(
        try_effect(require_effect(kBias), branch.base, ground, lack)->fitted.model, ground, folds);
    Finding f;
    f.effect = kBias;
    f.verdict = Verdict::kMissing;
    branch.d.findings.push_back(f);
  };
  ended.found = beside_rivals(round, {0, 1}, ended.base, ended.d, ground, folds, {}, with_bias);
  if (!ended.found.rivals.empty())
    take_what_is_shared(ended.found, ground, folds, ended.base, ended.d);
  return ended;
}

TEST(BesideRivals, WhatElseIsMissingTellsThemApart) {
  const Model truth = test::with(test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {6e3, 0.4}),
                                 kBias, {0.05, -0.03, 0.08});
  const Ended ended = go_on_beside(truth, "damper", "viscoelastic");
  EXPECT_EQ(ended.rivals(), std::vector<std::string>{"viscoelastic"});
  const Branch& branch = ended.found.branches[ended.found.best];
  EXPECT_TRUE(branch.base.fitted.model.has(kBias));
  ASSERT_EQ(branch.d.findings.size(), 2u);
  EXPECT_EQ(branch.d.findings[0].effect, "viscoelastic");
}

// On a flat top a gain along x is a scale of the motion along x.
TEST(BesideRivals, WhatStandsBesideBothIsMissingWhicheverIsThere) {
  const Model truth = test::with(test::with(test::elastic(1.5e4, 0.42), "sensor-gain", {1.2, 1}),
                                 kBias, {0.05, -0.03, 0.08});
  const Ended ended = go_on_beside(truth, "sensor-gain", "motion-scale");
  EXPECT_EQ(ended.rivals().size(), 2u);
  EXPECT_TRUE(ended.base.fitted.model.has(kBias));
  EXPECT_FALSE(ended.base.fitted.model.has("sensor-gain"));
  EXPECT_FALSE(ended.base.fitted.model.has("motion-scale"));
  ASSERT_EQ(ended.d.findings.size(), 1u);
  EXPECT_EQ(ended.d.findings[0].effect, kBias);
  EXPECT_EQ(ended.d.findings[0].verdict, Verdict::kMissing);
}

}  // namespace
}  // namespace hapsim
