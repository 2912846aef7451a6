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

// Of an elastic body, forces that fall in every second press while it is held, as of a tool that
// slips.
Experiment slipping() {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), 0.01, 3);
  for (const int e : all_episodes(w.dataset)) {
    int sample = 0;
    for (const int row : w.dataset.episodes[e].rows)
      w.dataset.recording.f[row] *= e % 2 == 0 ? 1.0 : std::max(0.5, 1 - 0.01 * sample++);
  }
  return w;
}

TEST(OneSize, WhatComesAndGoesWithPressesHasNone) {
  const Experiment w = slipping();
  const SizeSpread spread =
      size_spread("viscoelastic", fit(kWithOneTerm, w, all_episodes(w.dataset), {0.01, 0.01, true}),
                  TrialGround(w, {0.01, 0.01}));
  EXPECT_GT(spread.share, kOneSize);
  EXPECT_EQ(spread.among, "presses");
}

// Which takes the error from `now` to nothing [N].
Diagnosis with_finding(const std::string& effect, Verdict verdict, double now = 1) {
  Diagnosis d;
  Finding f;
  f.effect = effect;
  f.verdict = verdict;
  f.rmse_now = ForceError{now};
  d.findings.push_back(f);
  return d;
}

TEST(OneSize, SuchANameIsPossibleAtMostAndLeavesTheModel) {
  const Experiment w = slipping();
  const TrialGround ground(w, {0.01, 0.01});
  const Folds folds = make_folds(w.dataset, 6);
  Baseline base = make_baseline(kWithOneTerm, ground, folds);
  Diagnosis d = with_finding("viscoelastic", Verdict::kMissing);
  doubt_one(base, ground, folds, d);
  EXPECT_EQ(d.findings.front().verdict, Verdict::kPossible);
  EXPECT_TRUE(d.findings.front().doubted);
  EXPECT_NE(d.findings.front().evidence.find("its size differs"), std::string::npos);
  EXPECT_FALSE(base.fitted.model.has("viscoelastic"));
}

// A hum beside it, of which the name knows nothing: it must weigh more than what it leaves.
TEST(OneSize, WhatTakesLessThanIsLeftIsNotStoodBy) {
  Experiment w = test::experiment();
  test::measure_finer(w, kWithOneTerm, 0.01, 3);
  int sample = 0;
  for (Vec3& f : w.dataset.recording.f) f += 0.05 * std::sin(1.9 * ++sample) * Vec3::Ones();
  const TrialGround ground(w, {0.01, 0.01});
  const Folds folds = make_folds(w.dataset, 6);
  for (const double taken : {0.02, 0.06}) {
    Baseline base = make_baseline(kWithOneTerm, ground, folds);
    Diagnosis d = with_finding("viscoelastic", Verdict::kMissing, taken);
    doubt_one(base, ground, folds, d);
    const bool less = taken < 0.05 / std::sqrt(2);
    EXPECT_EQ(d.findings.front().verdict, less ? Verdict::kPossible : Verdict::kMissing);
    EXPECT_EQ(base.fitted.model.has("viscoelastic"), !less);
  }
}

TEST(OneSize, WhatLeavesNoMoreThanNoiseIsStoodBy) {
  Experiment w = test::experiment();
  test::measure_finer(w, kWithOneTerm, 0.01, 3);
  const TrialGround ground(w, {0.01, 0.01});
  const Folds folds = make_folds(w.dataset, 6);
  Baseline base = make_baseline(kWithOneTerm, ground, folds);
  Diagnosis d = with_finding("viscoelastic", Verdict::kMissing);
  doubt_one(base, ground, folds, d);
  EXPECT_EQ(d.findings.front().verdict, Verdict::kMissing);
  EXPECT_TRUE(base.fitted.model.has("viscoelastic"));
}

}  // namespace
}  // namespace hapsim
