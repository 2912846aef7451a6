// Intervals that standard errors stand for.
#include "model/interval.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

Parameter thickness(double value, double std_error) {
  return {"layer", 0, "thickness", value, "m", std_error, 2e-4, 0.1, ParameterState::kFree};
}

// Log-normal quantiles: exp(1.95996 x 0.5) = 2.66441.
TEST(Interval, OfASizeIsAFactorAndWithinItsBounds) {
  const ParameterInterval wide = interval95(thickness(1e-3, 0.5e-3));
  EXPECT_NEAR(wide.upper, 2.66441e-3, 1e-8);
  EXPECT_NEAR(wide.lower, 1e-3 / 2.66441, 1e-8);
  const ParameterInterval held = interval95(thickness(0.4e-3, 0.4e-3));
  EXPECT_EQ(held.lower, 2e-4);
  EXPECT_NEAR(held.upper, 0.4e-3 * 7.09907, 1e-7);
}

TEST(Interval, OfASignedValueIsEven) {
  const Parameter x{"inclusion", 0, "x", 0.01, "m", 0.001, -10, 10, ParameterState::kFree};
  EXPECT_NEAR(interval95(x).lower, 0.01 - 1.95996e-3, 1e-8);
  EXPECT_NEAR(interval95(x).upper, 0.01 + 1.95996e-3, 1e-8);
}

TEST(Interval, IsNotKnownWithoutAnError) {
  EXPECT_FALSE(interval95(thickness(1e-3, std::nan(""))).known());
  Parameter fixed = thickness(1e-3, 1e-4);
  fixed.state = ParameterState::kFixed;
  EXPECT_FALSE(interval95(fixed).known());
}

TEST(Interval, IsToldWhereItIsUneven) {
  const auto words = [](const Parameter& p) {
    return with_interval(p.value, p.unit, p.std_error, interval95(p), is_logarithmic(p), 4, 2);
  };
  EXPECT_EQ(words(thickness(1e-3, 0.5e-3)), "0.001 m (95 %: 0.00038 to 0.0027)");
  EXPECT_EQ(words(thickness(1e-3, 0.1e-3)), "0.001 m ± 0.0001");
  EXPECT_EQ(words(thickness(1e-3, std::nan(""))), "0.001 m");
}

}  // namespace
}  // namespace hapsim
