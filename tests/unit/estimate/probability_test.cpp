// Tail probabilities against closed forms and the first term of a series.
#include "estimate/probability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace hapsim {
namespace {

void expect_relative(double value, double exact, double tolerance) {
  EXPECT_NEAR(value / exact, 1, tolerance) << value << " and " << exact;
}

TEST(Probability, StudentOfOneAndTwoDegreesAreElementary) {
  for (const double t : {0.01, 0.3, 1.0, 2.5, 12.0, 300.0, 1e6}) {
    expect_relative(student_two_sided(t, 1), 2 / std::numbers::pi * std::atan(1 / t), 1e-13);
    const double root = std::sqrt(2 + t * t);  // 1 - t / root without cancellation
    expect_relative(student_two_sided(t, 2), 2 / (root * (root + t)), 1e-13);
    EXPECT_EQ(student_two_sided(-t, 2), student_two_sided(t, 2));
  }
}

// F of two degrees above: (1 + 2 f / d)^(-d / 2), in the limit exp(-f).
TEST(Probability, FisherOfTwoDegreesIsElementary) {
  for (const double d : {1.0, 3.0, 10.0, 250.0, 1e5, 1e6, 1e9}) {
    for (const double f : {0.05, 1.0, 4.0, 30.0}) {
      expect_relative(fisher_upper(f, 2, d), std::exp(-d / 2 * std::log1p(2 * f / d)), 1e-9);
    }
  }
}

TEST(Probability, FisherOfOneDegreeIsStudentSquared) {
  for (const double d : {1.0, 4.0, 30.0, 1e4}) {
    for (const double t : {0.2, 1.0, 3.0, 8.0}) {
      expect_relative(fisher_upper(t * t, 1, d), student_two_sided(t, d), 1e-12);
    }
  }
}

TEST(Probability, ManyDegreesAreTheNormalLaw) {
  for (const double t : {0.5, 1.7, 2.5}) {
    const double normal = std::erfc(t / std::sqrt(2.0));
    EXPECT_EQ(student_two_sided(t, 1e9), normal);
    // The first term beyond it: phi(t) t (t^2 + 1) / (2 d).
    const double density = std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi);
    const double d = 1e6;
    expect_relative(student_two_sided(t, d), normal + density * t * (t * t + 1) / (2 * d), 1e-9);
  }
}

TEST(Probability, EndsOfTheRange) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(student_two_sided(0, 5), 1);
  EXPECT_EQ(student_two_sided(infinity, 5), 0);
  EXPECT_EQ(fisher_upper(-1, 3, 5), 1);
  EXPECT_EQ(fisher_upper(infinity, 3, 5), 0);
  EXPECT_TRUE(std::isnan(student_two_sided(nan, 5)));
  EXPECT_TRUE(std::isnan(fisher_upper(nan, 3, 5)));
}

}  // namespace
}  // namespace hapsim
