#include "realtime/latency.h"

#include <gtest/gtest.h>

#include "realtime/real_time.h"

namespace hapsim {
namespace {

TEST(LatencyHistogram, ReadsQuantilesBackToThreePerCent) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 100000; ++i) histogram.add(37 * i);
  EXPECT_EQ(histogram.count(), 100000);
  EXPECT_EQ(histogram.largest(), 3700000);
  for (const double share : {0.001, 0.1, 0.5, 0.99, 0.9999}) {
    const double exact = 37 * 100000 * share;
    EXPECT_NEAR(static_cast<double>(histogram.quantile(share)), exact, 37 + 0.032 * exact);
  }
  EXPECT_EQ(histogram.quantile(1), 3700000);
}

TEST(LatencyHistogram, KeepsWhatIsRareAndOdd) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_EQ(histogram.summary(), "no samples");
  for (int i = 0; i < 999; ++i) histogram.add(5);
  histogram.add(std::int64_t{1} << 62);
  histogram.add(-3);  // a clock that went back
  EXPECT_EQ(histogram.quantile(0.5), 5);
  EXPECT_EQ(histogram.largest(), std::int64_t{1} << 62);
  EXPECT_EQ(histogram.quantile(0.0001), 0);
}

TEST(Pacer, IsNeverDueEarly) {
  Pacer pacer(2000);
  const std::int64_t first = pacer.wait();
  for (int i = 1; i <= 20; ++i) {
    const std::int64_t due = pacer.wait();
    EXPECT_EQ(due, first + i * pacer.period());
    EXPECT_GE(monotonic_ns(), due);
  }
}

}  // namespace
}  // namespace hapsim
