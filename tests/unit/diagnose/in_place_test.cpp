// What may stand in the place of an effect that was found.
#include "diagnose/in_place.h"

#include <gtest/gtest.h>

#include "support/synthetic.h"

namespace hapsim {
namespace {

// A sensor that settles, or a curve, stood for an offset that is there, or for itself.
TEST(InPlace, GivesWayToWhatItContainsWhereThatDoesAsWell) {
  Experiment w = test::experiment();
  const Gates gates;
  const auto simpler = [&](const Model& truth, const Model& found,
                           const std::string& earlier = "sensor-settling",
                           const std::string& unknown = "") {
    test::measure_finer(w, truth, 0.01, 3);
    const TrialGround ground(w, w.allowance());
    const Folds folds = make_folds(w.dataset, 6);
    return simpler_in_place(earlier, unknown, make_baseline(found, ground, folds), ground, folds,
                            gates);
  };
  const Model elastic = test::elastic(1.5e4, 0.42);
  const Model settling = test::with(elastic, "sensor-settling", {0, 0, 0.1, 60, 0.1, -0.05, 0.15});
  const auto offset = simpler(test::with(elastic, "sensor-bias", {0.1, -0.05, 0.15}), settling);
  ASSERT_TRUE(offset);
  EXPECT_EQ(offset->candidate.effect->card().name, "sensor-bias");
  EXPECT_TRUE(offset->base.fitted.model.has("sensor-bias"));
  EXPECT_FALSE(offset->base.fitted.model.has("sensor-settling"));
  EXPECT_FALSE(simpler(settling, settling));
  const auto drifting =
      simpler(test::with(elastic, "sensor-bias", {0.1, -0.05, 0.15}), settling, "sensor-settling",
              "sensor-bias");  // an effect that must not be known
  EXPECT_TRUE(!drifting || drifting->candidate.effect->card().name != "sensor-bias");
  std::vector<double> zeros;
  for (const ParameterCard& p : require_effect("learned-drift").card().parameters)
    zeros.push_back(p.unit == "s" ? 180 : 0.05);
  const auto constant = simpler(test::with(elastic, "sensor-bias", {0.1, -0.05, 0.15}),
                                test::with(elastic, "learned-drift", zeros), "learned-drift");
  ASSERT_TRUE(constant);
  EXPECT_EQ(constant->candidate.effect->card().name, "sensor-bias");
}

}  // namespace
}  // namespace hapsim
