// What strains the allowance for mesh and shape error, and of which kind it is.
#include "diagnose/left_over.h"

#include <gtest/gtest.h>

#include "support/synthetic.h"

namespace hapsim {
namespace {

const Model kTruth = test::elastic(1.5e4, 0.42);

// change(position, force) is what is measured of a force there.
template <class Change>
LeftOver left_of(double noise, const Change& change, bool refitted = true) {
  Experiment w = test::experiment();
  test::measure_finer(w, kTruth, noise, 3);
  const Selection all = all_episodes(w.dataset);
  for (const int e : all)
    for (const int row : w.dataset.episodes[e].rows) {
      Vec3& f = w.dataset.recording.f[row];
      f = change(w.dataset.episodes[e].position, f);
    }
  const TrialGround ground(w, {noise, 0.01});
  const Fit fitted = refitted ? fit(kTruth, w, all, {noise, 0.01, true}) : as_it_is(kTruth, w);
  LeftOver left = left_over(fitted, ground);
  tell_kinds(fitted, ground, left);
  return left;
}

TEST(LeftOver, IsNoiseWhereNothingIsHidden) {
  const LeftOver left = left_of(0.01, [](int, const Vec3& f) { return f; });
  EXPECT_TRUE(left.noise_alone()) << left.words;
  EXPECT_EQ(left.kind, "");
  EXPECT_EQ(left.words, "");
  EXPECT_LT(left.strain, 1);
  EXPECT_NEAR(left.error, 1, 0.1);
}

// A gain of all forces by delta, where each position is pressed in two directions, is delta times
// the projection on their plane, the least matrix that does it: two of the six squares that are
// allowed.
TEST(LeftOver, StrainIsCountedInWhatIsAllowed) {
  Experiment w = test::experiment();
  test::measure(w, kTruth, 1e-5, 3);
  for (const Episode& e : w.dataset.episodes)
    for (const int row : e.rows) {
      Vec3& f = w.dataset.recording.f[row];
      f *= 1.01;
    }
  const LeftOver left = left_over(as_it_is(kTruth, w), {w, {1e-5, 0.01}});
  EXPECT_NEAR(left.strain, 2.0 / 6, 0.02);
  EXPECT_FALSE(left.strained);
  EXPECT_NEAR(left.beside_gains, 1, 0.2);
}

TEST(LeftOver, WhatAllPositionsShareIsTheSetUp) {
  Eigen::Matrix3d shares;
  shares << 1, 0.05, 0.1, 0.05, 1, -0.1, 0.1, -0.1, 1;
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) { return Vec3(shares * f); });
  EXPECT_TRUE(left.strained);
  EXPECT_EQ(left.kind, "set-up") << left.words;
  EXPECT_GT(left.common, 5);
}

TEST(LeftOver, WhatDiffersByPlaceIsTheBody) {
  const LeftOver left =
      left_of(0.01, [](int p, const Vec3& f) { return Vec3((p % 2 ? 0.9 : 1.1) * f); });
  EXPECT_TRUE(left.strained);
  EXPECT_EQ(left.kind, "body") << left.words;
}

TEST(LeftOver, OnePositionAloneIsToldWithItsPlace) {
  const LeftOver left =
      left_of(0.01, [](int p, const Vec3& f) { return Vec3((p == 2 ? 1.3 : 1) * f); });
  EXPECT_TRUE(left.strained);
  EXPECT_EQ(left.kind, "place") << left.words;
  EXPECT_NE(left.words.find("(60.0, 30.0, 40.0) mm"), std::string::npos) << left.words;
}

// A support that slides sideways from 0.1 N on takes as much at all positions.
TEST(LeftOver, WhatOneLawOfTheForceTakesIsNoMatterOfPlace) {
  const LeftOver left = left_of(0.01, [](int, const Vec3& f) {
    const double side = std::hypot(f.x(), f.y()), kept = std::min(side, 0.1 + 0.2 * (side - 0.1));
    const double share = side > 0.1 ? kept / side : 1;
    return Vec3(share * f.x(), share * f.y(), f.z());
  });
  EXPECT_TRUE(left.strained);
  EXPECT_EQ(left.kind, "direction") << left.words;
}

// Gripped anew for each press, by chance.
TEST(LeftOver, WhatChangesFromPressToPressIsNoMatterOfPlace) {
  int sample = 0;
  double gain = 1;
  Random random(5);
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) {
    if (sample++ % 41 == 0) gain = 1 + 0.15 * random.normal();
    return Vec3(gain * f);
  });
  EXPECT_TRUE(left.strained);
  EXPECT_EQ(left.kind, "press") << left.words;
}

// A hum: the allowance does not hold it, and hs-compare finds nothing that it goes with.
TEST(LeftOver, AHumIsToldByItsFrequency) {
  int sample = 0;
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) {
    return Vec3(f + 0.03 * std::sin(0.8 * ++sample) * Vec3::Ones());
  });
  EXPECT_TRUE(left.structured);
  EXPECT_FALSE(left.strained);
  EXPECT_EQ(left.kind, "frequency") << left.words;
  EXPECT_NE(left.words.find(" Hz: "), std::string::npos) << left.words;
  EXPECT_NE(left.words.find("is no noise"), std::string::npos) << left.words;
}

// In four of eighteen presses, one after the other.
TEST(LeftOver, AHumOfAWhileIsToldWithItsTime) {
  int sample = 0;
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) {
    const int press = sample++ / 41;
    const double on = press >= 8 && press < 12 ? 0.1 : 0;
    return Vec3(f + on * std::sin(0.8 * sample) * Vec3::Ones());
  });
  EXPECT_EQ(left.kind, "frequency") << left.words;
  EXPECT_NE(left.words.find(" s: look"), std::string::npos) << left.words;
}

// From every fifth sample to every twentieth, through the session.
TEST(LeftOver, AHumThatRunsDownSwingsWithoutALine) {
  int sample = 0;
  double angle = 0;
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) {
    angle += 1.25 - 0.0012 * sample++;
    return Vec3(f + 0.05 * std::sin(angle) * Vec3::Ones());
  });
  EXPECT_EQ(left.kind, "frequency") << left.words;
  EXPECT_NE(left.words.find("It swings about"), std::string::npos) << left.words;
}

// Of neighbours that err otherwise, and at no frequency: a sensor that shows every reading twice,
// with the sign changed.
TEST(LeftOver, WhatSamplesForetellIsNoNoiseWhereNeighboursDiffer) {
  Random random(5);
  Vec3 last = Vec3::Zero();
  int sample = 0;
  const LeftOver left = left_of(0.01, [&](int, const Vec3& f) {
    last = sample++ % 2 == 0 ? Vec3(0.03 * Vec3(random.normal(), random.normal(), random.normal()))
                             : Vec3(-last);
    return Vec3(f + last);
  });
  EXPECT_TRUE(left.structured);
  EXPECT_FALSE(left.noise_alone());
}

}  // namespace
}  // namespace hapsim
