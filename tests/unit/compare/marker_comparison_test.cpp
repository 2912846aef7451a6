// Measured marked points against simulated ones: which rows are the same, what is left.
#include "compare/marker_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "expect_error.h"

namespace hapsim {
namespace {

// Two points over a second, the second a tenth of the first.
MarkerTable table(double scale) {
  MarkerTable t;
  t.name = "points.csv";
  t.points = {"near", "far"};
  t.rest = {Vec3(0.01, 0, 0), Vec3(0.03, 0, 0)};
  for (int i = 0; i <= 100; ++i)
    for (int p = 0; p < 2; ++p) {
      t.point.push_back(p);
      t.press.push_back(1);
      t.t.push_back(0.01 * i);
      t.u.emplace_back(0, 0, -scale * (p == 0 ? 1e-3 : 1e-4) * std::sin(0.03 * i));
    }
  return t;
}

TEST(MarkerComparison, OfTheModelsOwnLeavesNoise) {
  MarkerTable measured = table(1);
  add_marker_noise(measured, 2e-5, 1);
  const MarkerComparison c = compare_markers(measured, table(1));
  EXPECT_EQ(c.rows, 202u);
  EXPECT_EQ(c.missing, 0u);
  EXPECT_NEAR(c.rms, 2e-5, 3e-6);
  EXPECT_EQ(c.noise, 2e-5);
  EXPECT_TRUE(markers_explained(c));
  measured.metadata.remove("marker_noise");
  const MarkerComparison undeclared = compare_markers(measured, table(1));
  EXPECT_NEAR(undeclared.noise, 2e-5, 5e-6);
}

TEST(MarkerComparison, NamesTheWorstPoint) {
  MarkerTable measured = table(1.2);
  measured.metadata.set("marker_noise", "1e-6");
  const MarkerComparison c = compare_markers(measured, table(1));
  EXPECT_FALSE(markers_explained(c));
  EXPECT_EQ(c.points.front().name, "near");
  EXPECT_NEAR(c.points.front().rms, 10 * c.points.back().rms, 1e-9);
}

TEST(MarkerComparison, KnowsItsRowsByPointPressAndTime) {
  const MarkerTable measured = table(1);
  MarkerTable half = table(1);
  half.point.resize(100);
  half.press.resize(100);
  half.t.resize(100);
  half.u.resize(100);
  EXPECT_EQ(compare_markers(measured, half).missing, 102u);
  MarkerTable other = table(1);
  other.press.assign(other.rows(), 2);
  EXPECT_NE(error_of([&] { compare_markers(measured, other); }).find("no row has"),
            std::string::npos);
  MarkerTable moved = table(1);
  moved.rest[1].x() += 1e-3;
  EXPECT_NE(error_of([&] { compare_markers(measured, moved); }).find("point far"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
