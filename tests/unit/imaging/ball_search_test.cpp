// Balls found from sensitivities in closed form (made_presses.h).
#include "imaging/ball_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "imaging/image_field.h"
#include "made_presses.h"

namespace hapsim {
namespace {

class BallSearchTest : public MadePresses {
 protected:
  BallSearch search(const Eigen::VectorXd& data) const {
    const BallScene scene{contacts, surface, kTool, kDepth};
    return search_ball(J, grid, ball_candidates(J, grid, scene), data,
                       Eigen::VectorXd::Constant(data.size(), kNoise), scene);
  }
  static double sight(const BallSearch& found, double radius, double ratio) {
    for (const Sight& s : found.sight)
      if (s.radius == radius && s.ratio == ratio) return s.depth;
    return -1;
  }
};

TEST_F(BallSearchTest, FindsOneWithinItsErrors) {
  const Vec3 centre(0.052, 0.047, 0.049);
  const BallSearch found = search(gains(centre, 6e-3, 1.5, 1));
  ASSERT_TRUE(found.ball);
  const FoundBall& ball = *found.ball;
  EXPECT_LT((ball.centre - centre).head<2>().norm(), 2e-3);
  EXPECT_NEAR(ball.depth, 0.011, 3 * ball.depth_error);
  EXPECT_GT(ball.ratio, 1);
  EXPECT_GT(ball.drop, found.critical);
  EXPECT_LT(ball.chance, kFalseAlarm);
}

TEST_F(BallSearchTest, ASoftOneIsSofter) {
  const BallSearch found = search(gains({0.045, 0.055, 0.05}, 6e-3, -0.8, 2));
  ASSERT_TRUE(found.ball);
  EXPECT_LT(found.ball->ratio, 1);
}

TEST_F(BallSearchTest, SeesNothingWhereThereIsNothingOrTooDeep) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    seen += search(gains({0.05, 0.05, 0.03}, 6e-3, 0, seed)).ball ? 1 : 0;
    const BallSearch deep = search(gains({0.05, 0.05, 0.02}, 6e-3, 1.5, seed));
    seen += deep.ball ? 1 : 0;
    EXPECT_LT(sight(deep, 6e-3, 5), 0.04) << "and it says so";
  }
  EXPECT_EQ(seen, 0) << "of 8";
}

TEST_F(BallSearchTest, SightGrowsWithSizeAndContrast) {
  const BallSearch found = search(gains({0.05, 0.05, 0.03}, 6e-3, 0, 3));
  EXPECT_GT(sight(found, 6e-3, 5), 6e-3);
  EXPECT_GT(sight(found, 6e-3, 5), sight(found, 6e-3, 2));
  EXPECT_GT(sight(found, 12e-3, 5), sight(found, 6e-3, 5));
}

TEST_F(BallSearchTest, TheFieldIsHighestWhereTheBallIs) {
  const Vec3 centre(0.052, 0.047, 0.049);
  const Eigen::VectorXd data = gains(centre, 6e-3, 1.5, 4);
  std::vector<int> group;
  for (std::size_t p = 0; p < contacts.size(); ++p) group.push_back(static_cast<int>(p));
  const ImageField field =
      image_field(J, grid, group, data, Eigen::VectorXd::Constant(data.size(), kNoise),
                  Penalty::kTotalVariation);
  Eigen::Index highest = 0;
  field.log_ratio.maxCoeff(&highest);
  EXPECT_LT((field.grid.node(static_cast<std::size_t>(highest)) - centre).head<2>().norm(), 6e-3);
  EXPECT_LT(field.misfit, 0.7 * std::sqrt(data.squaredNorm() / double(data.size())));
  EXPECT_LT(field.held_out, 0.9 * std::sqrt(data.squaredNorm() / double(data.size())));
}

}  // namespace
}  // namespace hapsim
