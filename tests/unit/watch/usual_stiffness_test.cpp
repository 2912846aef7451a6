// How measured forces stand to a model's, press by press.
#include "watch/usual_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// Presses whose forces are 1.08 times the model's, each by 3 % of its own; from the 21st on half.
// Far apart, so that none tells of another.
PressFactors twenty_and_five(std::uint64_t seed) {
  PressFactors factors;
  Random random(seed);
  for (int press = 0; press < 25; ++press) {
    const double own = (press < 20 ? 1.08 : 0.5) + 0.03 * random.normal();
    for (int i = 0; i < 50; ++i) {
      const Vec3 model = std::sin(0.06 * i) * Vec3(0.1, -0.2, 1);
      factors.add(press, static_cast<std::size_t>(50 * press), Vec3(1.0 * press, 0, 0), model,
                  own * model);
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
  EXPECT_NEAR(share, 0.033, 0.004);  // a press's own, and what its neighbours are off
  EXPECT_NEAR(squares, 1, 0.35);     // Student's t of 19 degrees has 1.12
}

// A force that is off to one side, the further the more, is known between the presses.
TEST(PressFactors, TellWhereTheForceIsOff) {
  PressFactors factors;
  Random random(1);
  const auto truly_off = [](const Vec3& place) { return Vec3(0.05, 2 * place.x(), 0); };
  for (int press = 0; press < 41; ++press) {
    const Vec3 place(0.04 * random.uniform(), 0.04 * random.uniform(), 0.02);
    for (int i = 0; i < 50; ++i) {
      const Vec3 model = std::sin(0.06 * i) * Vec3(0, 0, 1);
      factors.add(press, static_cast<std::size_t>(50 * press), place, model,
                  model + model.norm() * truly_off(place));
    }
  }
  const UsualStiffness usual = factors.usual(2000, 0.2);
  EXPECT_NEAR(usual.factor, 1, 1e-12);
  double squares = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 place(0.04 * random.uniform(), 0.04 * random.uniform(), 0.02);
    squares += (usual.off_at(place) - truly_off(place)).squaredNorm() / 200;
  }
  EXPECT_LT(std::sqrt(squares), 0.015);  // of 0.08 and more
  EXPECT_LT(std::sqrt(squares), usual.share);
  EXPECT_LT(usual.share, 2 * std::sqrt(squares));
}

TEST(PressFactors, FewPressesTellNothing) {
  const UsualStiffness usual = twenty_and_five(1).usual(300, 0.1);
  EXPECT_EQ(usual.factor, 1);
  EXPECT_EQ(usual.error, 0.1);
  EXPECT_EQ(usual.share, 0.1);
}

}  // namespace
}  // namespace hapsim
