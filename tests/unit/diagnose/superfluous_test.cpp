// What nothing needs any more is dropped, what is needed stays.
#include "diagnose/superfluous.h"

#include <gtest/gtest.h>

#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Superfluous, OnlyWhatTheDataDoNotAskForIsDropped) {
  Experiment w = test::experiment();
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4});
  test::measure_finer(w, truth, 0.01, 3);
  const TrialGround ground(w, w.allowance());
  const Folds folds = make_folds(w.dataset, 6);
  const Baseline both = make_baseline(test::with(truth, "sensor-bias", {0, 0, 0}), ground, folds);
  const Gates gates;
  const auto without_bias = without_superfluous("sensor-bias", both, ground, folds, gates);
  ASSERT_TRUE(without_bias);
  EXPECT_FALSE(without_bias->fitted.model.has("sensor-bias"));
  EXPECT_TRUE(without_bias->fitted.model.has("viscoelastic"));
  EXPECT_LT(without_bias->held_out.error.pooled, 1.02 * both.held_out.error.pooled);
  EXPECT_FALSE(without_superfluous("viscoelastic", both, ground, folds, gates));
}

}  // namespace
}  // namespace hapsim
