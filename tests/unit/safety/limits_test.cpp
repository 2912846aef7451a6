#include "safety/limits.h"

#include <gtest/gtest.h>

#include "expect_error.h"

namespace hapsim {
namespace {

SafetyLimits read(const std::string& text) {
  Input input = Input::from_bytes(text, "device.csv");
  return read_limits(input);
}

TEST(Limits, AreReadFromADeviceFile) {
  const SafetyLimits limits =
      read("# device: a small one\nlimit,value,unit\nforce,3.3,N\nramp,0.05,s\nz_low,-0.1,m\n");
  EXPECT_EQ(limits.force, 3.3);
  EXPECT_EQ(limits.ramp, 0.05);
  EXPECT_EQ(limits.rate, SafetyLimits().rate) << "what is not named stays";
  EXPECT_FALSE(limits.contains({0, 0, -0.2}));
  EXPECT_TRUE(limits.contains({5, 5, 0}));
}

TEST(Limits, WhatMakesNoSenseIsRefused) {
  const auto refused = [](const std::string& rows, const std::string& what) {
    const std::string told = error_of([&] { read("limit,value\n" + rows); });
    EXPECT_NE(told.find(what), std::string::npos) << told;
  };
  refused("forse,3\n", "device.csv:2: there is no limit 'forse'; did you mean 'force'?");
  refused("force,nan\n", "device.csv:2: force is 'nan'");
  refused("force,0\n", "the limit of force is 0");
  refused("hold,-1\n", "the limit of hold is -1");
  refused("force,300\n", "faster than 1000 N/s");
  refused("x_low,1\nx_high,0\n", "no inside");
  EXPECT_NE(error_of([] { read("limit\nforce\n"); }).find("column 'value' is missing"),
            std::string::npos);
  EXPECT_NO_THROW(check(SafetyLimits()));
}

}  // namespace
}  // namespace hapsim
