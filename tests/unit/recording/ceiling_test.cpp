// Where a sensor's readings end.
#include "recording/ceiling.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

TEST(Ceiling, IsWhereReadingsAreTheSame) {
  std::vector<Vec3> f;
  for (int i = 0; i < 20; ++i) f.emplace_back(0.01 * i, 0, i % 2 == 0 ? 1.5 : -1.5);
  const auto c = find_ceilings(f);
  EXPECT_EQ(c[0].readings, 1u);
  EXPECT_FALSE(c[0].reached());
  EXPECT_FALSE(c[1].reached());  // an axis that was not measured
  EXPECT_EQ(c[2].readings, 20u);
  EXPECT_EQ(c[2].force, 1.5);
  EXPECT_EQ(ceiling_words(c), "20 readings of z are exactly 1.5 N in size, the largest");
}

TEST(Ceiling, IsNotThatOfAHoldWithNoise) {
  std::vector<Vec3> f;
  for (int i = 0; i < 20; ++i) f.emplace_back(0, 0, 1 - 1e-4 * i);
  EXPECT_EQ(ceiling_words(find_ceilings(f)), "");
  EXPECT_EQ(ceiling_words(find_ceilings({})), "");
}

}  // namespace
}  // namespace hapsim
