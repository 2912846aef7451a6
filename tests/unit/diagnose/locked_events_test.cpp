// Samples far off: outliers come anywhere, events at one part of the presses.
#include "diagnose/locked_events.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace hapsim {
namespace {

constexpr int kPresses = 12, kSamples = 100;

Dataset presses() {
  Dataset dataset;
  dataset.episodes.resize(kPresses);
  for (Episode& e : dataset.episodes) e.rows.resize(kSamples);
  return dataset;
}

// White noise of 1, of which one sample in a hundred is an outlier fifteen times as large.
Eigen::VectorXd with_outliers(Random& random) {
  Eigen::VectorXd r(3 * kPresses * kSamples);
  for (Eigen::Index i = 0; i < r.size(); i += 3) {
    const double size = random.uniform() < 0.01 ? 15 : 1;
    for (int k = 0; k < 3; ++k) r[i + k] = size * random.normal();
  }
  return r;
}

TEST(LockedEvents, OutliersAreNone) {
  const Dataset dataset = presses();
  Random random(5);
  int found = 0;
  for (int draw = 0; draw < 400; ++draw)
    found += find_locked_events(dataset, with_outliers(random), 1).found ? 1 : 0;
  EXPECT_LE(found, 1);
}

TEST(LockedEvents, ASpikeAtTheSamePartOfEachPressIsOne) {
  const Dataset dataset = presses();
  Random random(6);
  Eigen::VectorXd r = with_outliers(random);
  for (int p = 0; p < kPresses; ++p) r[3 * (p * kSamples + 41 + p % 2) + 2] = p % 3 ? 20 : -20;
  const LockedEvents events = find_locked_events(dataset, r, 1);
  EXPECT_TRUE(events.found);
  EXPECT_EQ(events.presses, kPresses);
  EXPECT_EQ(events.from, 0.4);
}

}  // namespace
}  // namespace hapsim
