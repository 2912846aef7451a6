// Offsets by press: solved for within a fit, and honest about presses that it has not seen.
#include "fit/press_offsets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic.h"

namespace hapsim {
namespace {

constexpr double kNoise = 0.01;

class PressOffsets : public ::testing::Test {
 protected:
  static Experiment& w() {
    static Experiment experiment = test::experiment();
    return experiment;
  }
  static std::vector<Vec3> disturb(double size) {
    test::measure(w(), test::elastic(1.5e4, 0.4), kNoise, 4);
    Random random(8);
    std::vector<Vec3> offsets;
    for (const Episode& e : w().dataset.episodes) {
      offsets.push_back(size * Vec3(random.normal(), random.normal(), random.normal()));
      for (const int row : e.rows) w().dataset.recording.f[row] += offsets.back();
    }
    return offsets;
  }
  static Model with_offsets() {
    return with_effect(as_it_is(test::elastic(1e4, 0.35), w()), "tare", w(),
                       all_episodes(w().dataset), {})
        .front();
  }
};

TEST_F(PressOffsets, AreFoundTogetherWithTheMaterial) {
  const std::vector<Vec3> truth = disturb(0.1);
  const Fit result = fit(with_offsets(), w(), all_episodes(w().dataset), {kNoise, 0, true});
  ASSERT_TRUE(result.converged) << result.message;
  EXPECT_NEAR(result.model.find("elastic", 0, "E")->value, 1.5e4, 400);
  EXPECT_LT(result.error.pooled, 1.05 * kNoise);
  int close = 0;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    const Parameter& b = *result.model.find("tare", 0, "bz" + std::to_string(p + 1));
    EXPECT_EQ(b.state, ParameterState::kDerived);
    EXPECT_NEAR(b.value, truth[p].z(), 0.05) << p;
    close += std::abs(b.value - truth[p].z()) < 0.01;
  }
  EXPECT_GT(close, static_cast<int>(truth.size()) / 2);
}

TEST_F(PressOffsets, OfUnseenPressesComeFromTheirOwnOtherStretches) {
  disturb(0.1);
  const Folds folds = make_folds(w().dataset, 3);
  const auto held_out = [&](const Model& model) {
    return held_out_error(
               [&](const Selection&) {
                 return Starts{{model}, {}};
               },
               w(), folds, {kNoise, 0, true})
        .error.pooled;
  };
  EXPECT_GT(held_out(test::elastic(1e4, 0.35)), 0.08);
  EXPECT_LT(held_out(with_offsets()), 1.2 * kNoise);
}

TEST_F(PressOffsets, OfPressesOfFewRowsComeFromTheOtherOnes) {
  Dataset few;
  few.episodes.resize(2);
  few.episodes[0].rows = {0, 1};
  few.episodes[1].rows = {2, 3, 4, 5, 6};
  Eigen::VectorXd offsets(21);
  offsets << Eigen::VectorXd::Constant(6, 3), Eigen::VectorXd::Constant(15, -5);
  take_out_cross_means(few, {0, 1}, offsets);
  EXPECT_LT(offsets.norm(), 1e-12);
}

TEST_F(PressOffsets, MeansComeOutOfColumns) {
  const Selection selection{1, 3};
  Eigen::MatrixXd columns = Eigen::MatrixXd::Random(
      3 * static_cast<Eigen::Index>(stacked_rows(w().dataset, selection).size()), 2);
  take_out_press_means(w().dataset, selection, columns);
  for (Eigen::Index c = 0; c < 2; ++c)
    EXPECT_LT(press_means(w().dataset, selection, columns.col(c)).norm(), 1e-12);
}

}  // namespace
}  // namespace hapsim
