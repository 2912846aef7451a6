// What a map of regions does to the error on unseen positions.
#include "diagnose/held_out.h"

#include <gtest/gtest.h>

#include "diagnose/superfluous.h"
#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kNoise = 0.01;

// Two corners far from each other are stiffer: neither can be told from the positions around it.
Workspace two_stiff_corners(const Model& model) {
  Workspace w = test::workspace();
  test::measure_finer(w, model, kNoise, 5);
  for (const Episode& e : w.dataset.episodes)
    for (const int row : e.rows)
      if (e.position == 0 || e.position == 5) w.dataset.recording.f[row] *= 1.8;
  return w;
}

Model with_map(const Model& model, Workspace& w) {
  const Selection all = all_episodes(w.dataset);
  ExtendOptions options = trial_extend_options(w);
  options.regions = 2;
  return fit(with_effect(model, "regions", w.dataset, all, *w.body, options).front(), w.dataset,
             all, *w.body, trial_fit_options(w))
      .model;
}

TEST(Unseen, OnAKnownMapOnlyTheRestIsUnseen) {
  Workspace w = two_stiff_corners(test::elastic(1.5e4, 0.42));
  const Folds folds = make_folds(w.dataset, 6);
  const Model model = with_map(test::elastic(1.5e4, 0.42), w);
  ASSERT_TRUE(has_map(model));
  EXPECT_GT(held_out_of(model, w, folds, Map::kAnew).rmse, 5 * kNoise);
  EXPECT_LT(held_out_of(model, w, folds, Map::kKnown).rmse, 2 * kNoise);
}

TEST(Unseen, ARegionOfOnePositionIsMadeAnew) {
  Workspace w = test::workspace();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), kNoise, 5);
  for (const Episode& e : w.dataset.episodes)
    for (const int row : e.rows)
      if (e.position == 0) w.dataset.recording.f[row] *= 1.8;
  const Folds folds = make_folds(w.dataset, 6);
  const Model model = with_map(test::elastic(1.5e4, 0.42), w);
  EXPECT_GT(held_out_of(model, w, folds, Map::kKnown).rmse, 5 * kNoise);
}

TEST(Unseen, WhatAnUnsureMapDrownsIsNotDropped) {
  const Model relaxing = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {1.8e3, 0.4});
  Workspace w = two_stiff_corners(relaxing);
  const Folds folds = make_folds(w.dataset, 6);
  const Baseline both = make_baseline(with_map(relaxing, w), w, folds);
  EXPECT_GT(both.held_out.rmse, 3 * both.on_known_map.rmse);
  EXPECT_FALSE(without_superfluous("viscoelastic", both, w, folds, Gates{}));
}

}  // namespace
}  // namespace hapsim
