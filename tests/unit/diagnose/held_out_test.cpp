// What a map of regions does to the error on unseen positions.
#include "diagnose/held_out.h"

#include <gtest/gtest.h>

#include "diagnose/superfluous.h"
#include "expect_error.h"
#include "fit/fit.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kNoise = 0.01;

// Two corners far from each other are stiffer: neither can be told from the positions around it.
Experiment two_stiff_corners(const Model& model) {
  Experiment w = test::experiment();
  test::measure_finer(w, model, kNoise, 5);
  for (const Episode& e : w.dataset.episodes)
    for (const int row : e.rows)
      if (e.position == 0 || e.position == 5) w.dataset.recording.f[row] *= 1.8;
  return w;
}

TrialGround ground(const Experiment& w) {
  return {w, w.allowance()};
}

Fit with_map(const Model& model, const Experiment& w) {
  const Selection all = all_episodes(w.dataset);
  ExtendOptions options = trial_extend_options(ground(w));
  options.regions = 2;
  return fit(with_effect(as_it_is(model, w), "regions", w, all, options).front(), w, all,
             trial_fit_options(ground(w)));
}

TEST(Unseen, OnAKnownMapOnlyTheRestIsUnseen) {
  const Experiment w = two_stiff_corners(test::elastic(1.5e4, 0.42));
  const Folds folds = make_folds(w.dataset, 6);
  const Fit fitted = with_map(test::elastic(1.5e4, 0.42), w);
  ASSERT_TRUE(has_map(fitted.model));
  EXPECT_GT(held_out_of(fitted, ground(w), folds, Map::kAnew).error.pooled, 5 * kNoise);
  EXPECT_LT(held_out_of(fitted, ground(w), folds, Map::kKnown).error.pooled, 2 * kNoise);
}

TEST(Unseen, ARegionOfOnePositionIsMadeAnew) {
  Experiment w = test::experiment();
  test::measure_finer(w, test::elastic(1.5e4, 0.42), kNoise, 5);
  for (const Episode& e : w.dataset.episodes)
    for (const int row : e.rows)
      if (e.position == 0) w.dataset.recording.f[row] *= 1.8;
  const Folds folds = make_folds(w.dataset, 6);
  const Fit fitted = with_map(test::elastic(1.5e4, 0.42), w);
  EXPECT_GT(held_out_of(fitted, ground(w), folds, Map::kKnown).error.pooled, 5 * kNoise);
}

TEST(Unseen, WhatAnUnsureMapDrownsIsNotDropped) {
  const Model relaxing = test::with(test::elastic(1.5e4, 0.42), "viscoelastic", {1.8e3, 0.4});
  const Experiment w = two_stiff_corners(relaxing);
  const Folds folds = make_folds(w.dataset, 6);
  const Baseline both = make_baseline(with_map(relaxing, w).model, ground(w), folds);
  EXPECT_GT(both.held_out.error.pooled, 3 * both.on_known_map.error.pooled);
  EXPECT_FALSE(without_superfluous("viscoelastic", both, ground(w), folds, Gates{}));
}

// Such a law may be asked for by what is left out, where others hold.
TEST(Unseen, ALawWithoutEquilibriumForetellsNothing) {
  const Model elastic = test::elastic(1.5e4, 0.42);
  Experiment w = test::experiment();
  test::measure_finer(w, elastic, kNoise, 5);
  Model extreme = test::with(elastic, "hyperelastic", {100, 0});
  for (Parameter& p : extreme.parameters) p.state = ParameterState::kFixed;
  EXPECT_NE(
      error_of([&] { fit(extreme, w, all_episodes(w.dataset), {}); }, ExitCode::kNoConvergence)
          .find("no equilibrium"),
      std::string::npos);
  const ModelBuilder builder = [&](const Selection&) { return Starts{{extreme}, {}}; };
  const HeldOut found = held_out_error(builder, w, make_folds(w.dataset, 6), {});
  double squares = 0;
  for (const Vec3& f : w.dataset.recording.f) squares += f.squaredNorm();
  EXPECT_NEAR(found.error.pooled,
              std::sqrt(squares / (3 * static_cast<double>(w.dataset.recording.f.size()))), 1e-9);
}

}  // namespace
}  // namespace hapsim
