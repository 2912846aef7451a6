// What is left goes with that by which presses that were left out are foretold.
#include "diagnose/left_kinds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "diagnose/left_over.h"
#include "diagnose/unseen_share.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kWhite = 0.01;

struct Sample {
  int press = 0, number = 0;  // number: of the sample in its press
  int here = 0;               // how often its place was pressed before
  Vec3 f, before;             // the model's force, and that of the sample before (0 before a press)
  Vec3 u, normal, place;
  double depth = 0;    // over the deepest
  double session = 0;  // share of the session
};

// Of an elastic model that leaves change(sample) and noise.
template <class Change>
std::vector<LeftKind> kinds_left(const Change& change) {
  const Model elastic = test::elastic(1.5e4, 0.42);
  Experiment w = test::experiment();
  test::measure(w, elastic, kWhite, 3);
  const Selection all = all_episodes(w.dataset);
  const Eigen::VectorXd f = model_forces(as_it_is(elastic, w), w, all, false).f;
  double deepest = 0;
  for (const Vec3& u : w.dataset.recording.u) deepest = std::max(deepest, u.norm());
  Random random(3);
  Eigen::VectorXd residual(f.size());
  Eigen::Index at = 0;
  std::map<int, int> pressed;
  for (const int e : all) {
    const Episode& episode = w.dataset.episodes[static_cast<std::size_t>(e)];
    Sample s;
    s.press = e;
    s.here = pressed[episode.position]++;
    s.normal = episode.view.normal;
    s.place = w.dataset.positions[static_cast<std::size_t>(episode.position)];
    for (const int row : episode.rows) {
      s.before = s.number == 0 ? Vec3(Vec3::Zero()) : s.f;
      s.f = f.segment<3>(at);
      s.u = w.dataset.recording.u[static_cast<std::size_t>(row)];
      s.depth = s.u.norm() / deepest;
      s.session = static_cast<double>(at) / static_cast<double>(f.size());
      const Vec3 noise(random.normal(), random.normal(), random.normal());
      residual.segment<3>(at) = change(s) + kWhite * noise;
      at += 3;
      ++s.number;
    }
  }
  const TrialGround ground(w, {kWhite, 0.01});
  return kinds_of(residual, f, ground);
}

std::string first_of(const std::vector<LeftKind>& kinds) {
  return kinds.empty() ? "" : kinds.front().kind;
}

TEST(LeftKinds, NoiseGoesWithNothing) {
  EXPECT_EQ(words_of(kinds_left([](const Sample&) { return Vec3(Vec3::Zero()); })), "");
}

// Foretold nearly whole: by the law itself, of which the noise leaves little unknown.
TEST(LeftKinds, AGainThatGoesWithDepthIsFoundByIt) {
  const auto kinds =
      kinds_left([](const Sample& s) { return Vec3(0.6 * s.depth * s.depth * s.f); });
  ASSERT_EQ(first_of(kinds), "depth");
  EXPECT_GT(kinds.front().share, 0.9);
  EXPECT_NE(words_of(kinds).find("the depth foretells "), std::string::npos);
}

// A foam on the tool that is flat after a place's first press: half of a small depth is lost there.
TEST(LeftKinds, WhatAFirstPressOfAPlaceLeavesGoesWithWhatWasPressedBefore) {
  const auto kinds = kinds_left(
      [](const Sample& s) { return Vec3((s.here == 0 ? -0.6 * (1 - s.depth) : 0) * s.f); });
  ASSERT_EQ(first_of(kinds), "cycle");
  EXPECT_GT(kinds.front().share, 0.9);
}

TEST(LeftKinds, AZeroIsOne) {
  EXPECT_EQ(first_of(kinds_left([](const Sample&) { return Vec3(0.05, -0.02, 0.03); })), "offset");
}

TEST(LeftKinds, AZeroThatRunsOnGoesWithTheSession) {
  const auto kinds = kinds_left(
      [](const Sample& s) { return Vec3(0.08 * std::sin(5 * s.session) * Vec3(1, -0.5, 0.7)); });
  EXPECT_EQ(first_of(kinds), "drift");
}

TEST(LeftKinds, AxesThatAreMixedAreTheSetUp) {
  EXPECT_EQ(first_of(kinds_left([](const Sample& s) { return Vec3(0.2 * s.f.z(), 0, 0); })),
            kSetUp);
}

TEST(LeftKinds, WhatASidewaysForcePushesUpGoesWithItsDirection) {
  EXPECT_EQ(first_of(kinds_left([](const Sample& s) {
              return Vec3(0.4 * (s.f - s.f.dot(s.normal) * s.normal).norm() * s.normal);
            })),
            kDirection);
}

TEST(LeftKinds, ABentScrewGoesWithTheTravelOfItsAxis) {
  const auto kinds =
      kinds_left([](const Sample& s) { return Vec3(0, 0, 0.08 * std::sin(5e3 * s.u.z())); });
  ASSERT_EQ(first_of(kinds), "depth");
  EXPECT_GT(kinds.front().share, 0.5);
}

// What slides holds less across the normal, wherever it is pushed: two gains say it, nine do too.
TEST(LeftKinds, AGainAcrossTheNormalGoesWithTheDirection) {
  const auto kinds =
      kinds_left([](const Sample& s) { return Vec3(-0.4 * (s.f - s.f.dot(s.normal) * s.normal)); });
  ASSERT_EQ(first_of(kinds), kDirection);
  EXPECT_GT(kinds.front().share, 0.9);
}

// An arm that swings about its foot: a turn that no two places share.
TEST(LeftKinds, ATurnThatGrowsFromPlaceToPlaceGoesWithThePlace) {
  const auto kinds = kinds_left(
      [](const Sample& s) { return Vec3(20 * (s.place.x() - 0.04) * s.normal.cross(s.f)); });
  ASSERT_EQ(first_of(kinds), kBody);
  EXPECT_GT(kinds.front().share, 0.9);
}

// A body that curls off its plate towards its rim and is pressed down to it first.
TEST(LeftKinds, AGapThatDiffersByPlaceGoesWithThePlace) {
  const auto kinds = kinds_left([](const Sample& s) {
    const double out = (s.place.x() - 0.04) / 0.02, gap = 0.3 * out * out;
    return Vec3(-0.8 * std::min(1.0, gap / std::max(s.depth, 1e-3)) * s.f);
  });
  ASSERT_EQ(first_of(kinds), kBody);
  EXPECT_GT(kinds.front().share, 0.6);
}

// Coulomb's friction of a guide: against the way it last went, and kept while it stands.
TEST(LeftKinds, AGuideThatDragsGoesWithThePhase) {
  double before = 0, against = 0;
  const auto kinds = kinds_left([&](const Sample& s) {
    if (s.number == 0) before = against = 0;
    if (s.u.z() != before) against = s.u.z() > before ? -1 : 1;
    before = s.u.z();
    return Vec3(0, 0, 0.08 * against);
  });
  ASSERT_EQ(first_of(kinds), "phase");
  EXPECT_GT(kinds.front().share, 0.9);
}

TEST(LeftKinds, OfOthersThoseAreAlikeThatForetellAsMuch) {
  const auto kinds =
      kinds_left([](const Sample& s) { return Vec3(0.6 * s.depth * s.depth * s.f); });
  ASSERT_GT(kinds.size(), 2);
  EXPECT_TRUE(kinds.front().alike);
  for (const LeftKind& kind : kinds)
    EXPECT_TRUE(kind.share > 0.8 || !kind.alike) << kind.kind << " " << kind.share;
}

// A sensor that rings after each change of the force, with a period of some six samples.
TEST(LeftKinds, RingingGoesWithWhatTheForceDidBefore) {
  Eigen::Matrix<double, 3, 2> state;  // by a second-order difference equation
  const auto kinds = kinds_left([&](const Sample& s) {
    if (s.number == 0) state.setZero();
    const Vec3 next = 1.8 * 0.5 * state.col(0) - 0.81 * state.col(1) + 0.5 * (s.f - s.before);
    state.col(1) = state.col(0);
    state.col(0) = next;
    return next;
  });
  EXPECT_EQ(first_of(kinds), "history");
}

TEST(LeftKinds, ACoarseConverterGoesWithTheReading) {
  const auto kinds = kinds_left(
      [](const Sample& s) { return Vec3((s.f / 0.15).array().round().matrix() * 0.15 - s.f); });
  EXPECT_EQ(first_of(kinds), "reading");
}

// By chance, and so foretold by no other press.
TEST(LeftKinds, AGainOfEachPressIsToldByThePressAlone) {
  Random random(8);
  double gain = 0;
  const auto kinds = kinds_left([&](const Sample& s) {
    if (s.number == 0) gain = 0.2 * random.normal();
    return Vec3(gain * s.f);
  });
  ASSERT_EQ(first_of(kinds), kPress);
  for (std::size_t k = 1; k < kinds.size(); ++k) EXPECT_LT(kinds[k].share, 0.5) << kinds[k].kind;
}

TEST(LeftKinds, AZeroOfEachPressIsToldByThePressAlone) {
  Random random(9);
  Vec3 zero = Vec3::Zero();
  const auto kinds = kinds_left([&](const Sample& s) {
    if (s.number == 0) zero = 0.06 * Vec3(random.normal(), random.normal(), random.normal());
    return zero;
  });
  EXPECT_EQ(first_of(kinds), kZeroOfPress);
}

TEST(UnseenShare, EachPositionsPressesAreInDifferentParts) {
  const Experiment w = test::experiment();
  const std::vector<int> parts = press_parts(w.dataset);
  std::map<int, std::set<int>> of;
  std::size_t at = 0;
  for (const Episode& e : w.dataset.episodes) {
    of[e.position].insert(parts[at]);
    at += e.rows.size();
  }
  EXPECT_EQ(at, parts.size());
  for (const auto& [position, seen] : of) EXPECT_EQ(seen.size(), 3) << position;
}

// A number that a part alone could tell is not known there.
TEST(UnseenShare, WhatOnePartAloneTellsIsNotForetold) {
  Eigen::VectorXd residual = Eigen::VectorXd::Ones(9);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Identity(9, 9);
  EXPECT_DOUBLE_EQ(unforetold_squares(columns, residual, {0, 1, 2}).sum(), 9);
  EXPECT_NEAR(unforetold_squares(Eigen::MatrixXd::Ones(9, 1), residual, {0, 1, 2}).sum(), 0, 1e-6);
}

}  // namespace
}  // namespace hapsim
