// How measured forces stand to a model's, press by press.
#include "realtime/usual_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// Presses whose forces are 1.08 times the model's, each by 3 % of its own; from the 21st on half.
PressFactors twenty_and_five(std::uint64_t seed) {
  PressFactors factors;
  Random random(seed);
  for (int press = 0; press < 25; ++press) {
    const double own = (press < 20 ? 1.08 : 0.5) + 0.03 * random.normal();
    for (int i = 0; i < 50; ++i) {
      const Vec3 model = std::sin(0.06 * i) * Vec3(0.1, -0.2, 1);
      factors.add(press, static_cast<std::size_t>(50 * press), model, own * model);
    }
  }
  return factors;
}

TEST(PressFactors, TellTheFactorWithItsError) {
  double squares = 0, share = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const UsualStiffness usual = twenty_and_five(seed).usual(1000, 0.1);
    squares += std::pow((usual.factor - 1.08) / usual.error, 2) / 200;
    share += usual.share / 200;
  }
  EXPECT_NEAR(share, 0.06, 0.003);  // of 0.1 in all
  EXPECT_NEAR(squares, 1, 0.35);    // Student's t of 19 degrees has 1.12
}

TEST(PressFactors, FewPressesTellNothing) {
  const UsualStiffness usual = twenty_and_five(1).usual(300, 0.1);
  EXPECT_EQ(usual.factor, 1);
  EXPECT_EQ(usual.error, 0.1);
  EXPECT_EQ(usual.share, 0.1);
}

}  // namespace
}  // namespace hapsim
