#include "base/units.h"

#include "expect_error.h"

namespace hapsim {
namespace {

TEST(Units, ConvertToSi) {
  EXPECT_EQ(unit_factor(Quantity::kLength, "mm"), 1e-3);
  EXPECT_EQ(unit_factor(Quantity::kForce, "mN"), 1e-3);
  EXPECT_EQ(unit_factor(Quantity::kPressure, "kPa"), 1e3);
  EXPECT_DOUBLE_EQ(180 * unit_factor(Quantity::kAngle, "deg"), 3.14159265358979323846);
}

TEST(Units, OfAnotherQuantityAreUnknown) {
  EXPECT_EQ(error_of([] { unit_factor(Quantity::kLength, "ms"); }, ExitCode::kUsage),
            "unknown unit 'ms'; use one of: m mm cm um in");
}

}  // namespace
}  // namespace hapsim
