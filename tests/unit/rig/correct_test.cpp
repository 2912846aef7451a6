#include "rig/correct.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "io/number.h"
#include "rig/rotation_vector.h"
#include "support/expect_words.h"

namespace hapsim {
namespace {

void set(Calibration& c, CalibratedNumber first, const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    c.numbers[first + k].value = values[k];
    c.numbers[first + k].state = "fitted";
  }
}

Calibration example() {
  Calibration c;
  c.name = "cal.csv";
  c.metadata.set("temp_ref", "20");
  set(c, kRotation, {0.1, -0.2, 0.3});
  set(c, kCrosstalk, {1.02, 0.98, 1.01, 0.01, -0.02, 0.015});
  set(c, kMass, {0.8});
  set(c, kGravity, {0, 0, -9.8});
  set(c, kOffset, {1, -2, 3});
  set(c, kDrift, {0.05, 0, -0.02});
  set(c, kCom, {0.01, 0.02, 0.05});
  set(c, kTorqueOffset, {0.1, 0.2, -0.1});
  set(c, kArm, {1e-5, 2e-5, 3e-5, 0, 0, 1e-6});
  return c;
}

// One row: the tool turned by a quarter about y, the body's force on it (base), at 26 degC.
Recording measured(const Calibration& c, const Vec3& f, bool turned) {
  const Eigen::Matrix3d R = turned ? rotation_of({0, 1.5707963267948966, 0})
                                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Vec3 weight = turned ? Vec3(0.8 * Vec3(0, 0, -9.8)) : Vec3(Vec3::Zero());
  Recording r;
  r.name = "data.csv";
  r.line = {2};
  r.press = {1};
  r.position = {Vec3::Zero()};
  r.u = {Vec3(0, 0, -1e-3)};
  r.temp = {26};
  r.f = {c.crosstalk() * c.rotation() * R.transpose() * (weight + f) + c.vector(kOffset) +
         6 * c.vector(kDrift)};
  const Vec3 torque =
      c.rotation() * c.vector(kCom).cross(R.transpose() * weight) + c.vector(kTorqueOffset);
  r.extra_header = {"tx", "ty", "tz"};
  for (int k = 0; k < 3; ++k) r.extra.push_back({format_number(torque[k])});
  if (turned) {
    r.extra_header.insert(r.extra_header.end(), {"qw", "qx", "qy", "qz"});
    for (const char* cell : {"0.7071067811865476", "0", "0.7071067811865476", "0"})
      r.extra.push_back({cell});
  }
  return r;
}

TEST(Correct, ForcesDisplacementsAndTorquesAreWhatTheyWere) {
  const Calibration c = example();
  const Vec3 f(0.5, -1, 4);
  Recording r = measured(c, f, true);
  r.metadata.set("force_noise", "0.01");
  const RigCorrection correction = calibrate_recording(c, r);
  EXPECT_LT((r.f[0] - f).norm(), 1e-12);
  EXPECT_LT((r.u[0] - Vec3(0, 0, -1e-3) - c.symmetric(kArm) * f).norm(), 1e-15);
  for (int k = 0; k < 3; ++k) {
    double torque = 1;
    ASSERT_TRUE(parse_number(r.extra[static_cast<std::size_t>(k)][0], torque));
    EXPECT_NEAR(torque, 0, 1e-12);
  }
  EXPECT_EQ(correction.done.size(), 6u);
  EXPECT_TRUE(correction.lacking.empty());
  EXPECT_NEAR(*r.force_noise(), 0.01, 3e-4);
  EXPECT_EQ(r.metadata.find("calibrated"), "cal.csv");
  expect_error([&] { calibrate_recording(c, r); }, ExitCode::kBadInput, "corrected before");
}

TEST(Correct, WithoutOrientationOrTemperatureItSaysWhatStays) {
  const Calibration c = example();
  const Vec3 f(0.5, -1, 4);
  Recording r = measured(c, f, false);
  EXPECT_EQ(calibrate_recording(c, r).lacking.size(), 1u);
  EXPECT_LT((r.f[0] - f).norm(), 1e-12);  // the tool's weight was not there either
  Recording cold = measured(c, f, false);
  cold.temp.clear();
  EXPECT_EQ(calibrate_recording(c, cold).lacking.size(), 2u);
  Recording fixed = measured(c, f, true);
  fixed.extra_header.resize(3);
  fixed.extra.resize(3);
  fixed.metadata.set("orientation", "0.7071067811865476,0,0.7071067811865476,0");
  EXPECT_TRUE(calibrate_recording(c, fixed).lacking.empty());
  EXPECT_LT((fixed.f[0] - f).norm(), 1e-12);
}

}  // namespace
}  // namespace hapsim
