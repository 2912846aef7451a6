#include "io/number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/random.h"

namespace hapsim {
namespace {

double parsed(std::string_view text) {
  double value = 0;
  return parse_number(text, value) ? value : NAN;
}

TEST(Number, IsTheWholeText) {
  EXPECT_EQ(parsed("1.5"), 1.5);
  EXPECT_EQ(parsed(" -2e-3\t"), -2e-3);
  EXPECT_EQ(parsed("+4"), 4);
  EXPECT_EQ(parsed(".5"), 0.5);
  EXPECT_EQ(parsed("5."), 5);
  for (const char* text : {"", " ", "1.5x", "1,5", "0x10", "1 2", "--1", "+-1", "abc", "1e", "-"})
    EXPECT_TRUE(std::isnan(parsed(text))) << text;
}

TEST(Number, IsFinite) {
  for (const char* text : {"nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e999"})
    EXPECT_TRUE(std::isnan(parsed(text))) << text;
}

TEST(Number, TooSmallIsZero) {
  EXPECT_EQ(parsed("1e-999"), 0);
}

TEST(Number, ReadsBackAsTheSameDouble) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const std::uint64_t bits = random.integer(UINT64_MAX);
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(parsed(format_number(value)), value) << format_number(value);
  }
  EXPECT_EQ(parsed(format_number(std::numeric_limits<double>::denorm_min())),
            std::numeric_limits<double>::denorm_min());
}

TEST(Number, IsWrittenShortest) {
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(1e-7), "1e-07");
  EXPECT_EQ(format_number(3), "3");
  EXPECT_EQ(format_number(-NAN), "nan");
}

TEST(Shown, CannotSteerATerminal) {
  EXPECT_EQ(shown("a\033[31mb"), "'a?[31mb'");
  EXPECT_LT(shown(std::string(1000, 'x')).size(), 60u);
}

}  // namespace
}  // namespace hapsim
