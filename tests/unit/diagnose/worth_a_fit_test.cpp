// Effects that most recordings have nothing of are fitted only where something like them is left.
#include <gtest/gtest.h>

#include "diagnose/candidate.h"
#include "effects/catalogue.h"
#include "fit/testable.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

const Model kElastic = test::elastic(1.5e4, 0.42);

Experiment measured(const Model& truth) {
  Experiment w = test::experiment();
  test::measure_finer(w, truth, 0.01, 3);
  return w;
}

bool is_worth(const std::string& effect, const Experiment& w) {
  const TrialGround ground(w, w.allowance());
  return worth_a_fit(require_effect(effect), make_baseline(kElastic, ground, {}), ground);
}

TEST(WorthAFit, IsNothingWhereNoiseIsLeft) {
  const Experiment w = measured(kElastic);
  const TrialGround ground(w, w.allowance());
  const Baseline base = make_baseline(kElastic, ground, {});
  int screened = 0;
  for (const Effect* effect : catalogue()) {
    const EffectCard& card = effect->card();
    const bool tried = card.screened && lacking_for(card, w.dataset).empty();
    screened += tried ? 1 : 0;
    EXPECT_EQ(worth_a_fit(*effect, base, ground), !tried) << card.name;
  }
  EXPECT_GE(screened, 3);
}

TEST(WorthAFit, IsWhatIsThere) {
  EXPECT_TRUE(is_worth("clock", measured(test::with(kElastic, "clock", {0.08, 0}))));
  EXPECT_TRUE(is_worth("filter", measured(test::with(kElastic, "filter", {1.5, 0.7}))));
  EXPECT_TRUE(is_worth("sensor-settling", measured(test::with(kElastic, "sensor-settling",
                                                              {0, 0, 0.06, 40, 0, 0, 0}))));
}

// 0.1 mm up and down at 0.37 Hz, twice the noise.
TEST(TryEffect, AMovingBodyIsTriedWhereAFrequencyStandsOut) {
  const Effect& breathing = require_effect("breathing");
  std::string lack;
  const Experiment still = measured(kElastic);
  const TrialGround nothing(still, still.allowance());
  EXPECT_FALSE(try_effect(breathing, make_baseline(kElastic, nothing, {}), nothing, lack));
  EXPECT_EQ(lack, kNoLine);
  const Experiment moving = measured(test::with(kElastic, "breathing", {0, 0, 1e-4, 0.37, 1}));
  const TrialGround ground(moving, moving.allowance());
  const auto candidate = try_effect(breathing, make_baseline(kElastic, ground, {}), ground, lack);
  ASSERT_TRUE(candidate) << lack;
  EXPECT_LT(candidate->fitted.error.pooled, 1.1 * ground.allowance.noise);
  const Parameter* f = candidate->fitted.model.find("breathing", 0, "f");
  EXPECT_NEAR(f->value, 0.37, 4 * f->std_error);
  EXPECT_LT(f->std_error, 1e-3);
}

}  // namespace
}  // namespace hapsim
