// Derivatives of whole models, recovery within the stated errors, and held-out data.
#include "fit/fit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "expect_error.h"
#include "model/interval.h"
#include "support/model_derivatives.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

class Fitted : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static FitOptions options() { return {0.01, 0, true}; }
};

TEST_F(Fitted, DerivativesOfAWholeModelAreDifferences) {
  Model model = test::with(
      test::with(test::with(test::with(test::elastic(1.5e4, 0.42), "hyperelastic", {0.1, 1}),
                            "viscoelastic", {6e3, 0.4}),
                 "tip", {100}),
      "sensor-lag", {0.03, 0.0137});
  const Selection selection{0, 1, 2, 7};
  test::expect_derivatives(w(), model, selection);
}

// How many intervals of 95 % hold what is true.
struct Covered {
  int held = 0, all = 0;
  void count(const Model& found, const Model& truth) {
    for (std::size_t i = 0; i < truth.parameters.size(); ++i, ++all) {
      const Parameter& p = found.parameters[i];
      held += std::abs(p.value - truth.parameters[i].value) < kHalf95 * p.std_error;
    }
  }
  double share() const {
    const double share = static_cast<double>(held) / all;
    std::printf("95 %% intervals cover the truth in %.1f %% of %d cases\n", 100 * share, all);
    return share;
  }
};

TEST_F(Fitted, StandardErrorsCoverTheTruthOverManySeeds) {
  const Model truth = test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.5});
  Covered covered;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::measure(w(), truth, 0.01, seed);
    Model start = truth;
    for (Parameter& p : start.parameters) p.value *= p.name == "nu" ? 0.9 : 1.3;
    const Fit result = fit(start, w(), all_episodes(w().dataset), options());
    ASSERT_TRUE(result.converged) << result.message;
    EXPECT_NEAR(result.error.pooled, 0.01, 0.0008);
    covered.count(result.model, truth);
  }
  EXPECT_GT(covered.share(), 0.88);
}

// As by a surface that does not lie where it is said to: no noise that samples have each by itself.
TEST_F(Fitted, StandardErrorsCoverWhereEachPressErrsAllAlong) {
  const Model truth = test::elastic(1.5e4, 0.4);
  Random random(11);
  Covered covered;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    test::measure(w(), truth, 0.01, seed);
    for (const Episode& e : w().dataset.episodes) {
      const double gain = 1 + 0.1 * random.normal();
      for (const int row : e.rows) w().dataset.recording.f[static_cast<std::size_t>(row)] *= gain;
    }
    const Fit result = fit(truth, w(), all_episodes(w().dataset), options());
    covered.count(result.model, truth);
  }
  EXPECT_GT(covered.share(), 0.88);
}

TEST_F(Fitted, WhatAllPositionsErrByAlikeIsInTheModulus) {
  const Model truth = test::elastic(1.5e4, 0.4);
  test::measure(w(), truth, 0.01, 3);
  const auto errors = [&](double floor) {
    FitOptions with = options();
    with.floor = floor;
    const Model found = fit(truth, w(), all_episodes(w().dataset), with).model;
    return std::pair(found.parameters[0].std_error / found.parameters[0].value,
                     found.parameters[1].std_error);
  };
  const auto [modulus, nu] = errors(0.02);
  EXPECT_GT(modulus, 0.02);
  EXPECT_LT(modulus, 0.03);
  // A gain of all forces is the modulus alone: of nu the positions' own errors count as before.
  const auto [half_modulus, half_nu] = errors(0.01);
  EXPECT_NEAR(nu / half_nu, 2, 0.3);
  EXPECT_GT(half_modulus, 0.01);
}

// One straight press tells E / (1 - nu^2) alone: nu may end at its bound, and E far off.
TEST_F(Fitted, AModulusIsAsUnsureAsTheRatioThatIsAtItsBound) {
  const Model truth = test::elastic(1.5e4, 0.42);
  FitOptions with = options();
  with.floor = 0.005;
  int at_bound = 0, held = 0, held_by_curvature = 0, inside = 0, held_inside = 0;
  for (int draw = 0; draw < 240; ++draw) {
    const int press = 3 * (draw % 6);  // straight
    if (press == 0) test::measure(w(), truth, 0.03, static_cast<std::uint64_t>(draw + 1));
    with.ridges = true;
    const Fit found = fit(test::elastic(1.4e4, 0.3), w(), {press}, with);
    with.ridges = false;
    const Fit by_curvature = fit(test::elastic(1.4e4, 0.3), w(), {press}, with);
    ASSERT_TRUE(found.converged) << found.message;
    const auto holds = [](const Fit& fitted) {
      const ParameterInterval modulus = interval95(fitted.model.parameters[0]);
      return modulus.lower < 1.5e4 && 1.5e4 < modulus.upper;
    };
    (found.at_bound.empty() ? inside : at_bound) += 1;
    (found.at_bound.empty() ? held_inside : held) += holds(found);
    if (!found.at_bound.empty()) held_by_curvature += holds(by_curvature);
  }
  std::printf(
      "E held in %d of %d with nu at its bound (by the curvature alone %d), in %d of %d others\n",
      held, at_bound, held_by_curvature, held_inside, inside);
  ASSERT_GT(at_bound, 20);
  EXPECT_GE(held, 0.9 * at_bound);
}

TEST_F(Fitted, AnEffectAndItsAbsenceShowInHeldOutPositions) {
  const Model truth = test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.5});
  test::measure(w(), truth, 0.01, 3);
  const Folds folds = make_folds(w().dataset, 6);
  EXPECT_EQ(folds.by, "positions");
  const auto held_out = [&](const Model& start) {
    return held_out_error(
               [&](const Selection&) {
                 return Starts{{start}, {}};
               },
               w(), folds, options())
        .error.pooled;
  };
  EXPECT_GT(held_out(test::elastic(1.5e4, 0.4)), 0.02);
  EXPECT_LT(held_out(truth), 0.0115);
}

// What a watch speaks to, a terminal or an interpreter, is one thread's.
TEST_F(Fitted, OfFoldsFittedSideBySideTheWatchIsAskedByTheCallerAlone) {
  test::measure(w(), test::with(test::elastic(1.5e4, 0.4), "viscoelastic", {8e3, 0.5}), 0.01, 3);
  const Folds folds = make_folds(w().dataset, 6);
  const ModelBuilder builder = [](const Selection&) {
    return Starts{{test::with(test::elastic(1e4, 0.4), "viscoelastic", {4e3, 0.2})}, {}};
  };
  FitOptions watched = options();
  std::atomic<int> asked{0}, elsewhere{0};
  watched.watch = [&, own = std::this_thread::get_id()](const FitProgress&) {
    ++asked;
    elsewhere += std::this_thread::get_id() != own;
    return true;
  };
  const HeldOut with = held_out_error(builder, w(), folds, watched);
  EXPECT_GT(asked, 0);
  EXPECT_EQ(elsewhere, 0);
  const HeldOut without = held_out_error(builder, w(), folds, options());
  EXPECT_EQ(with.squares, without.squares);
  EXPECT_EQ(with.by_place, without.by_place);
}

TEST_F(Fitted, PoissonsRatioFixedStaysFixed) {
  test::measure(w(), test::elastic(1.2e4, 0.4), 0.01, 5);
  Model start = test::elastic(1e4, 0.4);
  start.find("elastic", 0, "nu")->state = ParameterState::kFixed;
  const Fit result = fit(start, w(), all_episodes(w().dataset), options());
  EXPECT_EQ(result.model.find("elastic", 0, "nu")->value, 0.4);
  EXPECT_NEAR(result.model.find("elastic", 0, "E")->value, 1.2e4, 150);
}

TEST_F(Fitted, RegionsAreFoundFromThePositionsOwnModuli) {
  // Positions with x > 0.05 m twice as stiff, by gains on the homogeneous forces.
  test::measure(w(), test::elastic(1e4, 0.4), 0.002, 9);
  for (std::size_t i = 0; i < w().dataset.rows(); ++i)
    if (w().dataset.recording.position[i].x() > 0.05) w().dataset.recording.f[i] *= 2;
  const Selection all = all_episodes(w().dataset);
  const Fit base = fit(test::elastic(1e4, 0.4), w(), all, options());
  ExtendOptions extend;
  extend.noise = 0.002;
  extend.floor = 0.01;
  const Model model = with_effect(base, "regions", w(), all, extend).front();
  const MaterialSpec material = material_of(model);
  ASSERT_EQ(material.modulus.size(), 2u);
  EXPECT_NEAR(material.modulus[1] / material.modulus[0], 2, 0.05);
  for (std::size_t k = 0; k < material.key_point.size(); ++k)
    EXPECT_EQ(material.key_region[k], material.key_point[k].x() > 0.05 ? 1 : 0);
  // Truly solved, the stiff side's share of a soft position's stiffness is there but small.
  const Fit fitted = fit(model, w(), all, options());
  EXPECT_TRUE(fitted.converged);
  EXPECT_LT(fitted.error.pooled, 0.2 * base.error.pooled);
}

TEST_F(Fitted, WithoutTimeRelaxationCannotBeAdded) {
  Experiment still = test::experiment();
  still.dataset.recording.t.clear();
  const Model model = test::elastic(1e4, 0.4);
  EXPECT_NE(error_of([&] { with_effect(as_it_is(model, still), "viscoelastic", still, {0}, {}); },
                     ExitCode::kBadInput)
                .find("no column t"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
