#include "report/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/palette.h"
#include "report/plot.h"

namespace hapsim {
namespace {

TEST(Ticks, AreRoundNumbersThatTakeInTheData) {
  const Ticks ticks = nice_ticks(0.3, 9.7, 5, true);
  EXPECT_EQ(ticks.lower, 0);
  EXPECT_EQ(ticks.upper, 10);
  EXPECT_EQ(ticks.at, (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticks.label(4), "4");
}

TEST(Ticks, ShowAsManyDecimalsAsTheStepNeeds) {
  const Ticks ticks = nice_ticks(-0.04, 0.05, 4, true);
  EXPECT_EQ(ticks.label(0.02), "0.02");
  EXPECT_EQ(ticks.label(-1e-18), "0.00");
  EXPECT_EQ(ticks.label(-0.02),
            "\xe2\x88\x92"
            "0.02");
}

TEST(Ticks, SurviveAnything) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [low, high] : {std::pair{5.0, 5.0},
                                  {0.0, 0.0},
                                  {nan, nan},
                                  {3.0, -3.0},
                                  {1e-12, 2e-12},
                                  {1e9, 3e9},
                                  {-1e300, 1e300}}) {
    const Ticks ticks = nice_ticks(low, high, 5, true);
    EXPECT_LT(ticks.lower, ticks.upper);
    EXPECT_GE(ticks.at.size(), 2u);
    EXPECT_LE(ticks.at.size(), 13u);
  }
}

TEST(Plot, EscapesItsWordsAndHasNoNan) {
  Plot plot(300, 200, "<x>", "y & z");
  plot.line({0, 1, 2}, {0, std::nan(""), 2}, {}, "a<b");
  plot.band({0, 1}, {0, 1}, {1, 2}, {});
  const std::string svg = plot.svg();
  EXPECT_NE(svg.find("&lt;x&gt;"), std::string::npos);
  EXPECT_NE(svg.find("a&lt;b"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Plot, WithoutDataIsStillAPlot) {
  EXPECT_EQ(Plot(300, 200, "x", "y").svg().find("nan"), std::string::npos);
  EXPECT_EQ(Plot(300, 200, "x", "y").svg().find("inf"), std::string::npos);
}

TEST(Palette, DarkensAllTheWay) {
  double last = 1e9;
  for (double share = 0; share <= 1; share += 0.05) {
    const Rgb c = error_colour(share);
    const double lightness = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
    EXPECT_LT(lightness, last);
    last = lightness;
  }
  EXPECT_EQ(css(Rgb{255, 0, 16}), "#ff0010");
}

}  // namespace
}  // namespace hapsim
