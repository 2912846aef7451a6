#include "calibrate/arm_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "rig/correct.h"
#include "support/expect_words.h"
#include "unit/calibrate/rig.h"

namespace hapsim {
namespace {

Eigen::Matrix3d arm() {
  return (Eigen::Matrix3d() << 4, 0.5, 0.2, 0.5, 3, -0.4, 0.2, -0.4, 1.5).finished() * 1e-5;
}

// Presses of a rigid block along its faces, up to 20 N and back; contact found 0.02 mm wrong.
Recording presses(Random& random, int axes, double noise) {
  Recording r;
  r.name = "block.csv";
  for (int p = 0; p < 2 * axes; ++p) {
    const Vec3 wrong = test::normals(random, 2e-5);
    for (int i = 0; i <= 20; ++i) {
      Vec3 f =
          (20 - 2 * std::abs(i - 10)) * (axes == 1 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::Unit(p % 3)));
      if (axes > 1) f += 0.3 * f.norm() * Vec3::Unit((p + 1) % 3);  // friction
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(p);
      r.t.push_back(0.1 * i);
      r.position.emplace_back(0, 0, 0.04);
      r.f.push_back(f);
      r.u.push_back(wrong - arm() * f + test::normals(random, noise));
    }
  }
  return r;
}

TEST(ArmFit, PressesAlongThreeAxesTellAllWithTheirErrors) {
  double inside = 0, count = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Random random(static_cast<std::uint64_t>(seed + 1));
    const ArmFit fit = fit_arm(presses(random, 3, 3e-6));
    EXPECT_TRUE(fit.open.empty());
    for (std::size_t k = 0; k < kSymmetric; ++k) {
      const double truth = arm()(kSymmetricPlaces[k].row, kSymmetricPlaces[k].column);
      EXPECT_NEAR(fit.numbers[k].value, truth, 5 * fit.numbers[k].std_error);
      EXPECT_LT(fit.numbers[k].std_error, 2e-7);
      inside += fit.numbers[k].lower <= truth && truth <= fit.numbers[k].upper;
      count += 1;
    }
  }
  EXPECT_NEAR(inside / count, 0.95, 0.03);
}

TEST(ArmFit, PressesAlongOneAxisTellItsColumnAndSayWhatIsOpen) {
  Random random(1);
  Recording r = presses(random, 1, 1e-6);
  const ArmFit fit = fit_arm(r);
  ASSERT_EQ(fit.open.size(), 1u);
  EXPECT_NE(fit.open[0].find("arm_xx, arm_yy, arm_xy taken for 0"), std::string::npos);
  EXPECT_NEAR(fit.numbers[2].value, arm()(2, 2), 4e-7);
  EXPECT_NEAR(fit.numbers[4].value, arm()(0, 2), 4e-7);
  EXPECT_EQ(fit.numbers[0].state, "assumed");
  // What it explains is gone once it is corrected.
  Calibration c;
  add_arm(fit, r, c);
  calibrate_recording(c, r);
  for (std::size_t i = 1; i < 21; ++i) EXPECT_LT((r.u[i] - r.u[0]).norm(), 1e-5);
}

TEST(ArmFit, PressesThatTellNothingAreRefused) {
  Random random(1);
  Recording still = presses(random, 1, 0);
  for (Vec3& f : still.f) f = Vec3(0, 0, 2);
  expect_error([&] { fit_arm(still); }, ExitCode::kBadInput, "a force that changes");
  Recording away = presses(random, 1, 1e-6);
  for (Vec3& u : away.u) u = -u;
  expect_error([&] { fit_arm(away); }, ExitCode::kBadInput, "moves with the force");
}

}  // namespace
}  // namespace hapsim
