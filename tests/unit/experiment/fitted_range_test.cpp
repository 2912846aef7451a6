// What hs-identify writes down of the presses that a model was fitted to, and what is read of it.
#include "experiment/fitted_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "expect_error.h"

namespace hapsim {
namespace {

// Presses at these places, down by `deep` within a second and held there for another.
Dataset presses_at(const std::vector<Vec3>& places, double deep, bool timed = true) {
  Recording r;
  r.name = "data.csv";
  r.metadata.set("tool_radius", "0.004");
  for (std::size_t p = 0; p < places.size(); ++p)
    for (int i = 0; i <= 40; ++i) {
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(static_cast<int>(p));
      if (timed) r.t.push_back(3.0 * static_cast<double>(p) + 0.05 * i);
      r.position.push_back(places[p]);
      r.u.emplace_back(0, 0, -deep * std::min(1.0, 0.05 * i));
      r.f.push_back(Vec3::Zero());
    }
  return make_dataset(std::move(r));
}

FittedRange range_of(const Dataset& dataset) {
  Metadata metadata;
  record_range(dataset, metadata);
  metadata.set("depth", "0.003");
  return fitted_range(metadata, "model");
}

TEST(FittedRange, IsWhatWasPressed) {
  const FittedRange one = range_of(presses_at({{0.1, -0.02, 0.04}}, 0.003));
  EXPECT_EQ(one.depth, 0.003);
  EXPECT_NEAR(one.speed, 0.003, 1e-12);
  ASSERT_EQ(one.places.size(), 1U);
  EXPECT_EQ(one.places[0], Vec3(0.1, -0.02, 0.04));
  EXPECT_NEAR(one.reach, 0.008, 2e-5);
  EXPECT_EQ(one.covers, 0);  // all places are told
  EXPECT_TRUE(one.has_place({0.107, -0.02, 0.04}));
  EXPECT_FALSE(one.has_place({0.109, -0.02, 0.04}));
  EXPECT_TRUE(one.has_speed(one.speed) && !one.has_speed(0.0031));
  EXPECT_TRUE(one.has_depth(0.003) && !one.has_depth(0.0031));
}

TEST(FittedRange, ManyPlacesAreAsFarApartAsTheyLie) {
  // 15 x 15 places 10 mm apart, and one far off, which says nothing of what lies between.
  std::vector<Vec3> places;
  for (int i = 0; i < 225; ++i) places.emplace_back(0.01 * (i % 15), 0.01 * (i / 15), 0);
  places.emplace_back(0.5, 0.07, 0);
  const FittedRange grid = range_of(presses_at(places, 0.001));
  EXPECT_LE(grid.places.size(), 64U);
  for (const Vec3& p : places) EXPECT_TRUE(grid.has_place(p)) << p.transpose();
  for (int i = 0; i < 196; ++i)
    EXPECT_TRUE(grid.has_place(Vec3(0.01 * (i % 14) + 0.005, 0.01 * (i / 14) + 0.005, 0)));
  EXPECT_FALSE(grid.has_place({0.3, 0.07, 0}));
  EXPECT_LT(grid.reach, 0.031);
  for (const Vec3& p : places)
    EXPECT_TRUE(std::any_of(grid.places.begin(), grid.places.end(), [&](const Vec3& q) {
      return (p - q).norm() <= grid.covers;
    })) << p.transpose();
}

TEST(FittedRange, WithoutWordsIsEndless) {
  const FittedRange none = fitted_range({}, "model");
  EXPECT_TRUE(none.has_depth(1) && none.has_speed(1e3) && none.has_place({1, 2, 3}));
  Metadata metadata;
  metadata.set("speed", "0.5");  // of the model that was started from
  record_range(presses_at({{0, 0, 0}}, 0.001, false), metadata);
  EXPECT_FALSE(metadata.find("speed"));
  EXPECT_TRUE(metadata.find("places"));
}

TEST(FittedRange, SaysWhatIsWrong) {
  const auto wrong = [](const char* key, const char* value) {
    Metadata metadata;
    metadata.set(key, value);
    return error_of([&] { fitted_range(metadata, "m.csv"); }, ExitCode::kBadInput);
  };
  EXPECT_NE(wrong("places", "1 2 x").find("metadata places has 'x'"), std::string::npos)
      << wrong("places", "1 2 x");
  EXPECT_NE(wrong("places", "1 2").find("2 numbers"), std::string::npos);
  EXPECT_NE(wrong("speed", "-1").find("speed is -1"), std::string::npos);
}

TEST(ToolSpeed, IsOfWaysNotOfSamples) {
  ToolSpeed speed;
  EXPECT_EQ(speed.add(0, {0, 0, 0}), 0);
  EXPECT_EQ(speed.add(0.001, {0, 0, -1e-3}), 0);  // too soon to say
  EXPECT_NEAR(speed.add(0.02, {0, 0, -1e-3}), 0.05, 1e-12);
  EXPECT_NEAR(speed.add(1.02, {0, 0, -2e-3}), 0.001, 1e-12);
  speed.restart();
  EXPECT_EQ(speed.add(5, {1, 0, 0}), 0);
}

}  // namespace
}  // namespace hapsim
