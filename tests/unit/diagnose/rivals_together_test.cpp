// Two effects that are both there are no rivals; two that stand for each other are.
#include "diagnose/rivals_together.h"

#include <gtest/gtest.h>

#include "effects/catalogue.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

bool both_act_on(const Model& truth, const std::string& a, const std::string& b) {
  Experiment w = test::experiment();
  test::measure_finer(w, truth, 0.01, 3);
  const TrialGround ground(w, w.allowance());
  const Baseline base = make_baseline(test::elastic(1.5e4, 0.42), ground, {});
  std::string lack;
  const auto first = try_effect(require_effect(a), base, ground, lack);
  const auto second = try_effect(require_effect(b), base, ground, lack);
  EXPECT_TRUE(first && second) << lack;
  return first && second && both_act(*first, *second, ground);
}

const Model kRelaxing = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {6e3, 0.4});

TEST(BothAct, WhereEachLeavesWhatTheOtherTakesAway) {
  const Model truth = test::with(kRelaxing, "sensor-bias", {0.05, -0.03, 0.08});
  EXPECT_TRUE(both_act_on(truth, "viscoelastic", "sensor-bias"));
  EXPECT_TRUE(both_act_on(truth, "sensor-bias", "viscoelastic"));
}

TEST(BothAct, NotWhereOneStandsForTheOther) {
  EXPECT_FALSE(both_act_on(kRelaxing, "viscoelastic", "damper"));
  EXPECT_FALSE(both_act_on(kRelaxing, "damper", "sensor-bias"));
}

}  // namespace
}  // namespace hapsim
