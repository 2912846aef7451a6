// What is said of places that nobody has pressed.
#include "fit/held_out_band.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "expect_error.h"

namespace hapsim {
namespace {

// Places with forces of 1 N rms each, whose errors are these, and no noise to speak of.
struct Places {
  Dataset dataset;
  Allowance allowance{1e-9, 0.001};
  HeldOut held_out;
  Folds folds{{{0}}, "positions"};
  explicit Places(const std::vector<double>& errors) {
    dataset.recording.f = {Vec3::Ones()};
    dataset.positions.assign(errors.size(), Vec3::Zero());
    for (const double error : errors) {
      Episode e;
      e.position = static_cast<int>(held_out.by_place.size());
      e.rows = {0};
      dataset.episodes.push_back(e);
      held_out.by_place.push_back(3 * error * error);
    }
  }
  UnseenBand band() const {
    const auto n = 3 * static_cast<Eigen::Index>(held_out.by_place.size());
    return held_out_band(held_out, folds, dataset, allowance, Eigen::VectorXd::Ones(n));
  }
};

// The law of the errors does not matter: here a few places err much more than most.
TEST(HeldOutBand, HoldsForTheNextPlaceAsOftenAsItSays) {
  Random random(3);
  const auto error = [&] { return 0.02 * std::exp(1.5 * random.normal()); };
  int within = 0, all = 0;
  for (int draw = 0; draw < 400; ++draw) {
    std::vector<double> errors(40);
    for (double& e : errors) e = error();
    const UnseenBand band = Places(errors).band();
    EXPECT_EQ(band.chance, 0.95);
    for (int k = 0; k < 20; ++k, ++all) within += error() <= band.share;
  }
  EXPECT_GE(within, 0.94 * all);
  EXPECT_LE(within, 0.985 * all);  // 39 of 41
}

TEST(HeldOutBand, FewPlacesPromiseLess) {
  const UnseenBand band = Places({0.02, 0.08, 0.01}).band();
  EXPECT_NEAR(band.share, 0.08, 1e-9);
  EXPECT_EQ(band.chance, 0.75);
  EXPECT_FALSE(Places({0.02}).band().known());
}

TEST(HeldOutBand, KnowsNothingOfPlacesFromPresses) {
  Places places({0.02, 0.08, 0.01});
  places.folds.by = "presses";
  EXPECT_FALSE(places.band().known());
}

TEST(HeldOutBand, LeavesTheNoiseOutAndMeshAndShapeIn) {
  Places places({0.05, 0.05, 0.05});
  places.allowance.noise = 0.04;
  EXPECT_NEAR(places.band().share, 0.03, 1e-9);
  places.allowance.floor = 0.07;
  EXPECT_EQ(places.band().share, 0.07);
}

TEST(UnseenBand, ComesBackFromTheModelsMetadata) {
  Metadata metadata;
  EXPECT_FALSE(recorded_band(metadata, "m.csv").known());
  record_band({0.083, 0.95}, metadata);
  const UnseenBand band = recorded_band(metadata, "m.csv");
  EXPECT_EQ(band.share, 0.083);
  EXPECT_EQ(band.chance, 0.95);
  record_band({}, metadata);
  EXPECT_FALSE(metadata.find("unseen_band"));
  for (const char* chance : {"1", "-0.5", "often"}) {
    metadata.set("unseen_band", "0.083");
    metadata.set("unseen_chance", chance);
    EXPECT_EQ(error_of([&] { recorded_band(metadata, "m.csv"); }).rfind("m.csv: ", 0), 0u);
  }
}

}  // namespace
}  // namespace hapsim
