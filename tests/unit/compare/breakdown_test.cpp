#include "compare/breakdown.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/comparison.h"
#include "compare/error_map.h"
#include "compare/trend.h"
#include "estimate/probability.h"
#include "synthetic_recording.h"

namespace hapsim {
namespace {

std::vector<Observation> observe(const Synthetic& s, double noise) {
  return find_structure(row_facts(s.measured), s.measured.f, s.simulated, noise);
}

const Breakdown& named(const std::vector<Breakdown>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(),
                       [&](const Breakdown& b) { return b.grouping.name == name; });
}

TEST(Breakdown, GainErrorOfOneBinIsFoundWithinItsStandardError) {
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Synthetic s =
        synthetic(24, 6, 0.02, seed, [](const RowState& r) { return r.position == 2 ? 1.1 : 1.0; });
    const auto all = break_down(row_facts(s.measured), s.measured.f, s.simulated, 0.02);
    const auto& errors = named(all, "position").errors;
    for (std::size_t b = 0; b < errors.size(); ++b) {
      const double z = (errors[b].gain - (b == 2 ? 1.1 : 1.0)) / errors[b].gain_error;
      EXPECT_LT(std::abs(z), 5);
      outside += std::abs(z) > 2;
    }
  }
  EXPECT_LT(outside, 12);  // of 120, six expected
}

TEST(Breakdown, DepthBinsHoldSimilarCounts) {
  const Synthetic s = synthetic(60, 6, 0.02, 3);
  const auto all = break_down(row_facts(s.measured), s.measured.f, s.simulated, 0.02);
  std::size_t rows = 0;
  for (const BinError& e : named(all, "depth").errors) {
    rows += e.rows;
    EXPECT_GT(e.rows, s.measured.rows() / 30);
  }
  EXPECT_EQ(rows, s.measured.rows());
}

TEST(Breakdown, ComponentsCountByTheirDimensions) {
  const Synthetic s = synthetic(20, 5, 0.02, 4);
  const auto all = break_down(row_facts(s.measured), s.measured.f, s.simulated, 0.02);
  for (const BinError& e : named(all, "direction").errors) EXPECT_NEAR(e.rmse, 0.02, 0.001);
}

TEST(Structure, NoiseAloneSaysNothing) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    alarms +=
        !observe(synthetic(12 + static_cast<int>(seed % 3) * 12, 6, 0.02, seed), 0.02).empty();
  EXPECT_LT(alarms, 10);  // under 5 %
}

TEST(Structure, FewPressesOfNoiseSayNothingEither) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    alarms += !observe(synthetic(1 + static_cast<int>(seed % 5), 2, 0.02, seed), 0.02).empty();
  EXPECT_LT(alarms, 10);
}

TEST(Structure, NamesWhatWasHidden) {
  const auto first = [](const Synthetic& s) {
    const auto all = observe(s, 0.02);
    return all.empty() ? std::string("nothing") : all[0].kind;
  };
  EXPECT_EQ(first(synthetic(24, 6, 0.02, 1, [](const RowState&) { return 0.9; })), "overall");
  EXPECT_EQ(
      first(synthetic(24, 6, 0.02, 1, [](const RowState& r) { return 1 + 0.06 * r.position; })),
      "position");
  EXPECT_EQ(first(synthetic(24, 6, 0.02, 1, [](const RowState& r) { return 0.85 + 60 * r.depth; })),
            "depth");
  EXPECT_EQ(first(synthetic(24, 6, 0.02, 1,
                            [](const RowState& r) { return 0.9 + 0.3 * std::exp(-r.t / 0.4); })),
            "contact-time");
  EXPECT_EQ(
      first(synthetic(24, 6, 0.02, 1, {}, [](const RowState&) { return Vec3(0.03, -0.04, 0.06); })),
      "offset");
  EXPECT_EQ(first(synthetic(
                24, 6, 0.02, 1, {},
                [](const RowState& r) -> Vec3 { return Vec3(0.2e-3, 0, 0.3e-3) * r.session; })),
            "drift");
}

TEST(Structure, SaysTheSizeInWords) {
  const auto all =
      observe(synthetic(24, 6, 0.02, 1, [](const RowState&) { return 1 / 1.18; }), 0.02);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].sentence,
            "The model is too stiff by 18 % on the whole: its force is too large.");
  EXPECT_GT(all[0].share, 0.95);
}

// Gains of the presses that are the same on the average at each place and round of presses.
TEST(Structure, WhatChangesFromPressToPressIsToldSo) {
  const std::vector<double> gains{0.8, 1.2, 1.1, 0.9};
  const Synthetic s = synthetic(24, 6, 0.02, 4, [&](const RowState& r) {
    return gains[static_cast<std::size_t>(r.press / 6 + r.position) % gains.size()];
  });
  const auto found = observe(s, 0.02);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.back().kind, "press") << found.back().sentence;
  EXPECT_NE(found.back().sentence.find("from press to press"), std::string::npos);
}

TEST(Structure, ExactForcesWithoutNoiseAreNoStructure) {
  Synthetic s = synthetic(6, 3, 0.02, 1);
  s.simulated = s.measured.f;
  EXPECT_TRUE(observe(s, 0).empty());
}

TEST(Probability, MatchesTables) {
  EXPECT_NEAR(student_two_sided(2.228, 10), 0.05, 1e-4);
  EXPECT_NEAR(student_two_sided(1.959964, 1e9), 0.05, 1e-6);
  EXPECT_NEAR(student_two_sided(12.706, 1), 0.05, 1e-5);
  EXPECT_NEAR(fisher_upper(3.3258, 5, 10), 0.05, 1e-4);
  EXPECT_NEAR(fisher_upper(2.2141, 5, 1e6), 0.05, 1e-4);
}

TEST(Comparison, JsonTellsTheNumbers) {
  const Synthetic s = synthetic(12, 4, 0.02, 1, [](const RowState&) { return 0.8; });
  Recording simulated = s.measured;
  simulated.f = s.simulated;
  const Comparison c = compare(s.measured, simulated);
  const auto json = nlohmann::json::parse(comparison_json(c, "a\"b", "b\xff"));
  EXPECT_EQ(json["measured"], "a\"b");
  EXPECT_EQ(json["presses"], 12);
  EXPECT_EQ(json["positions"], 4);
  EXPECT_DOUBLE_EQ(json["rmse"], c.size.rmse);
  EXPECT_EQ(json["noise_source"], "force_noise");
  EXPECT_EQ(json["observations"][0]["kind"], "overall");
  EXPECT_TRUE(json["breakdowns"]["position"][0]["lower"].is_null());
  EXPECT_NEAR(json["breakdowns"]["position"][0]["gain"], 0.8, 0.02);
}

TEST(ErrorMap, IsExactAtPositionsAndUnknownFarAway) {
  Surface square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const ErrorMap map = map_error(square, {{0, 0, 0}, {0.1, 0, 0}}, {1, 3}, 0.3);
  EXPECT_NEAR(map.error[0], 1, 0.01);
  EXPECT_GT(map.distance[2], map.reach);
  EXPECT_GT(map.surface.faces.size(), 2u);
  double area = 0;
  for (std::size_t f = 0; f < map.surface.faces.size(); ++f)
    area += face_normal(map.surface, static_cast<int>(f)).norm() / 2;
  EXPECT_NEAR(area, 1, 1e-12);  // refined, and nothing lost or doubled
}

TEST(Trend, MeanAndItsClusteredError) {
  const std::vector<double> x{1, 1, 2, 2}, y{1, 3, 10, 14};
  const Trend trend = binned_trend(x, y, {0, 1, 0, 1}, 2);
  ASSERT_EQ(trend.mean.size(), 2u);
  EXPECT_DOUBLE_EQ(trend.mean[0], 2);
  EXPECT_DOUBLE_EQ(trend.error[0], std::sqrt(2 * (1.0 + 1.0)) / 2);
}

TEST(Trend, ThinningKeepsEndsAndExtremes) {
  std::vector<double> y(10000, 0);
  y[1234] = 5;
  y[4321] = -7;
  const auto rows = thinned(y, 300);
  EXPECT_LE(rows.size(), 300u);
  for (const std::size_t row : {0ul, 1234ul, 4321ul, 9999ul})
    EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), row));
}

}  // namespace
}  // namespace hapsim
