// An effect that acts has one size; one that stands for another cause has not.
#include "diagnose/one_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/synthetic.h"

namespace hapsim {
namespace {

const Model kWithOneTerm = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {5e3, 0.4});

// Of the relaxation fitted to what change(press, sample, force) leaves of the truth's forces.
template <class Change>
SizeSpread spread_with(const Change& change) {
  Experiment w = test::experiment();
  test::measure_finer(w, kWithOneTerm, 0.01, 3);
  const Selection all = all_episodes(w.dataset);
  for (const int e : all) {
    int sample = 0;
    for (const int row : w.dataset.episodes[e].rows) {
      Vec3& f = w.dataset.recording.f[row];
      f = change(e, sample++, f);
    }
  }
  const TrialGround ground(w, {0.01, 0.01});
  return size_spread("viscoelastic", fit(kWithOneTerm, w, all, {0.01, 0.01, true}), ground);
}

TEST(OneSize, WhatActsHasOne) {
  const SizeSpread spread = spread_with([](int, int, const Vec3& f) { return f; });
  EXPECT_LT(spread.share, 0.1) << spread.among;
}

// Far larger than the noise: it has nothing to do with what relaxes.
TEST(OneSize, AHumBesideItChangesNothing) {
  const SizeSpread spread = spread_with(
      [](int, int i, const Vec3& f) { return Vec3(f + 0.05 * std::sin(1.9 * i) * Vec3::Ones()); });
  EXPECT_LT(spread.share, 0.2) << spread.among;
}

// Forces that fall by chance of each press while it is held, as of a tool that slips: none, or
// twice as much as in the mean.
TEST(OneSize, WhatComesAndGoesWithPressesHasNone) {
  const Model elastic = test::elastic(1.5e4, 0.42);
  Experiment w = test::experiment();
  test::measure_finer(w, elastic, 0.01, 3);
  const Selection all = all_episodes(w.dataset);
  for (const int e : all) {
    int sample = 0;
    for (const int row : w.dataset.episodes[e].rows)
      w.dataset.recording.f[row] *= e % 2 == 0 ? 1.0 : std::max(0.5, 1 - 0.01 * sample++);
  }
  const TrialGround ground(w, {0.01, 0.01});
  const SizeSpread spread =
      size_spread("viscoelastic", fit(kWithOneTerm, w, all, {0.01, 0.01, true}), ground);
  EXPECT_GT(spread.share, kOneSize);
  EXPECT_EQ(spread.among, "presses");
}

}  // namespace
}  // namespace hapsim
