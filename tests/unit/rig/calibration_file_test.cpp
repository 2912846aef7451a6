#include <gtest/gtest.h>

#include <sstream>

#include "rig/calibration.h"
#include "support/expect_words.h"

namespace hapsim {
namespace {

Calibration read(const std::string& text) {
  Input input = Input::from_bytes(text, "cal.csv");
  return read_calibration(input);
}
const std::string kTurn =
    "parameter,value,unit\nrotation_x,0.1,rad\nrotation_y,0,rad\nrotation_z,0,rad\n";

TEST(CalibrationFile, ReadsWhatItWrites) {
  Calibration c =
      read("# temp_ref: 21\n" + kTurn + "offset_x,1,N\noffset_y,2,N\noffset_z,3,N\nmass,0.5,kg\n");
  c.numbers[kMass].std_error = 0.01;
  c.numbers[kMass].lower = 0.48;
  c.numbers[kMass].upper = 0.52;
  c.numbers[kMass].state = "fitted";
  std::ostringstream out;
  write_calibration(out, c);
  const Calibration again = read(out.str());
  for (std::size_t k = 0; k < kCalibratedNumbers; ++k) {
    EXPECT_EQ(again.numbers[k].value, c.numbers[k].value);
    EXPECT_EQ(again.numbers[k].state, c.numbers[k].state);
  }
  EXPECT_EQ(again.numbers[kMass].upper, 0.52);
  EXPECT_EQ(again.temp_ref(), 21);
  EXPECT_TRUE(again.has_sensor());
  EXPECT_FALSE(again.has(kCrosstalk));
  EXPECT_EQ(again.crosstalk(), Eigen::Matrix3d::Identity());
}

TEST(CalibrationFile, SaysWhatIsWrong) {
  const auto refused = [](const std::string& text, const std::string& words) {
    expect_error([&] { read(text); }, ExitCode::kBadInput, words);
  };
  refused(kTurn + "ofset_x,1,N\n",
          "cal.csv:5: a calibration has no parameter 'ofset_x'; did you "
          "mean 'offset_x'?");
  refused(kTurn + "rotation_x,1,rad\n", "cal.csv:5: rotation_x stands here again");
  refused(kTurn + "mass,1,g\n", "cal.csv:5: mass is in 'g'; give it in kg");
  refused(kTurn + "offset_x,1,N\n", "offset_y is missing beside offset_x");
  refused("parameter,value\nmass,1\n", "it calibrates neither a sensor nor an arm");
  refused(kTurn + "mass,-1,kg\n", "mass is -1 kg");
  refused(kTurn + "drift_x,1,N/K\ndrift_y,0,N/K\ndrift_z,0,N/K\n", "no temperature");
  refused(kTurn +
              "crosstalk_xx,1,1\ncrosstalk_yy,0,1\ncrosstalk_zz,1,1\ncrosstalk_xy,0,1\n"
              "crosstalk_xz,0,1\ncrosstalk_yz,0,1\n",
          "cannot be undone");
}

}  // namespace
}  // namespace hapsim
