#include "base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

TEST(Random, RepeatsWithItsSeed) {
  Random a(7), b(7), c(8);
  const double first = a.uniform();
  EXPECT_EQ(first, b.uniform());
  EXPECT_NE(first, c.uniform());
}

TEST(Random, IsTheSameOnEveryMachine) {
  // The standard fixes the 10000th number of this generator.
  std::mt19937_64 engine;
  engine.discard(9999);
  EXPECT_EQ(engine(), 9981545732273789042ULL);
}

TEST(Random, NormalHasMeanZeroAndVarianceOne) {
  Random random(1);
  double sum = 0, squares = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2.0 / n));
}

TEST(Random, IntegersAreEquallyLikely) {
  Random random(2);
  int counts[3] = {};
  for (int i = 0; i < 30000; ++i) ++counts[random.integer(3)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * std::sqrt(30000 * 2.0 / 9));
}

}  // namespace
}  // namespace hapsim
