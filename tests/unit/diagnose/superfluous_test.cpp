// What nothing needs any more is dropped, what is needed stays.
#include "diagnose/superfluous.h"

#include <gtest/gtest.h>

#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

TEST(Superfluous, OnlyWhatTheDataDoNotAskForIsDropped) {
  Workspace w = test::workspace();
  const Model truth = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4});
  test::measure_finer(w, truth, 0.01, 3);
  const Folds folds = make_folds(w.dataset, 6);
  const Baseline both = make_baseline(test::with(truth, "sensor-bias", {0, 0, 0}), w, folds);
  const Gates gates;
  const auto without_bias = without_superfluous("sensor-bias", both, w, folds, gates);
  ASSERT_TRUE(without_bias);
  EXPECT_FALSE(without_bias->fitted.model.has("sensor-bias"));
  EXPECT_TRUE(without_bias->fitted.model.has("viscoelastic"));
  EXPECT_LT(without_bias->held_out.rmse, 1.02 * both.held_out.rmse);
  EXPECT_FALSE(without_superfluous("viscoelastic", both, w, folds, gates));
}

}  // namespace
}  // namespace hapsim
