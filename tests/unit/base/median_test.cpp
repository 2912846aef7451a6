#include "base/median.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"

namespace hapsim {
namespace {

TEST(Median, OfAnOddNumberIsTheMiddleOne) {
  EXPECT_EQ(median({5, 1, 3}), 3);
  EXPECT_EQ(upper_median({5, 1, 3}), 3);
  EXPECT_EQ(median({2}), 2);
  EXPECT_EQ(upper_median({2}), 2);
}

TEST(Median, OfAnEvenNumberIsTheMeanOfTheTwoMiddleOnes) {
  EXPECT_EQ(median({8, 1, 4, 2}), 3);
  EXPECT_EQ(median({1, 2}), 1.5);
}

TEST(Median, UpperOfAnEvenNumberIsTheUpperOfTheTwoMiddleOnes) {
  EXPECT_EQ(upper_median({8, 1, 4, 2}), 4);
  EXPECT_EQ(upper_median({1, 2}), 2);
}

TEST(Median, OfNoneIsZero) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(upper_median({}), 0);
  EXPECT_EQ(quantile({}, 0.9), 0);
  EXPECT_EQ(nth_smallest({}, 3), 0);
}

TEST(Quantile, IsTheElementAtThatShareOfTheWay) {
  const std::vector<double> values{40, 10, 50, 20, 30};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.25), 20);
  EXPECT_EQ(quantile(values, 0.49), 20);
  EXPECT_EQ(quantile(values, 0.5), 30);
  EXPECT_EQ(quantile(values, 0.99), 40);
  EXPECT_EQ(quantile(values, 1), 50);
}

TEST(Quantile, EveryRankIsThatOfTheSortedValues) {
  Random random(1);
  for (std::size_t n = 1; n < 60; ++n) {
    std::vector<double> values(n);
    for (double& v : values) v = std::round(10 * random.normal());  // with equal ones
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t rank = 0; rank < n; ++rank)
      EXPECT_EQ(nth_smallest(values, rank), sorted[rank]);
    EXPECT_EQ(nth_smallest(values, n), sorted.back());
    EXPECT_EQ(upper_median(values), sorted[n / 2]);
    EXPECT_EQ(median(values), (sorted[(n - 1) / 2] + sorted[n / 2]) / 2);
  }
}

}  // namespace
}  // namespace hapsim
