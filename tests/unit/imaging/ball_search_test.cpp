// Balls found from sensitivities in closed form: the energy of a point load falls with the fourth
// power of the distance.
#include "imaging/ball_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "imaging/image_field.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr double kTool = 4e-3, kStep = 3e-3, kDepth = 0.05, kNoise = 0.004;

class BallSearchTest : public ::testing::Test {
 protected:
  BallSearchTest() : surface(boundary_surface(test::block_mesh({0.1, 0.1, 0.06}, 10, 10, 6, 1))) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        PreparedContact contact;
        contact.point = {0.025 + 0.01 * i, 0.025 + 0.01 * j, 0.06};
        contact.normal = Vec3::UnitZ();
        contacts.push_back(contact);
      }
    grid.step = kStep;
    grid.count = {34, 34, 21};
    J.resize(static_cast<Eigen::Index>(contacts.size()), static_cast<Eigen::Index>(grid.size()));
    for (std::size_t p = 0; p < contacts.size(); ++p)
      for (std::size_t n = 0; n < grid.size(); ++n) J(p, n) = energy(p, grid.node(n));
    whole = J.rowwise().sum() * std::pow(kStep, 3);
    for (Eigen::Index p = 0; p < J.rows(); ++p) J.row(p) /= J.row(p).sum();
  }
  double energy(std::size_t p, const Vec3& at) const {
    return std::pow((at - contacts[p].point).squaredNorm() + kTool * kTool, -2);
  }
  // What a ball that counts as `effect` of its volume does, integrated finely, and noise.
  Eigen::VectorXd gains(const Vec3& centre, double radius, double effect,
                        std::uint64_t seed) const {
    Random random(seed);
    Eigen::VectorXd data(J.rows());
    const double fine = radius / 12;
    for (Eigen::Index p = 0; p < J.rows(); ++p) {
      double inside = 0;
      for (double x = -radius; x <= radius; x += fine)
        for (double y = -radius; y <= radius; y += fine)
          for (double z = -radius; z <= radius; z += fine)
            if (x * x + y * y + z * z < radius * radius)
              inside += energy(p, centre + Vec3(x, y, z)) * std::pow(fine, 3);
      data[p] = effect * inside / whole[p] + kNoise * random.normal();
    }
    return data;
  }
  BallSearch search(const Eigen::VectorXd& data) const {
    return search_balls(J, grid, data, Eigen::VectorXd::Constant(data.size(), kNoise),
                        {contacts, surface, kTool, kDepth});
  }
  static double sight(const BallSearch& found, double radius, double ratio) {
    for (const Sight& s : found.sight)
      if (s.radius == radius && s.ratio == ratio) return s.depth;
    return -1;
  }
  Surface surface;
  std::vector<PreparedContact> contacts;
  FieldGrid grid;
  Eigen::MatrixXd J;
  Eigen::VectorXd whole;  // energy of each press
};

TEST_F(BallSearchTest, FindsOneWithinItsErrors) {
  const Vec3 centre(0.052, 0.047, 0.049);
  const BallSearch found = search(gains(centre, 6e-3, 1.5, 1));
  ASSERT_EQ(found.balls.size(), 1u);
  const FoundBall& ball = found.balls[0];
  EXPECT_LT((ball.centre - centre).head<2>().norm(), 2e-3);
  EXPECT_NEAR(ball.depth, 0.011, 3 * ball.depth_error);
  EXPECT_GT(ball.ratio, 1);
  EXPECT_GT(ball.drop, 30);
}

TEST_F(BallSearchTest, ASoftOneIsSofter) {
  const BallSearch found = search(gains({0.045, 0.055, 0.05}, 6e-3, -0.8, 2));
  ASSERT_FALSE(found.balls.empty());
  EXPECT_LT(found.balls[0].ratio, 1);
}

TEST_F(BallSearchTest, SeesNothingWhereThereIsNothingOrTooDeep) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    seen += search(gains({0.05, 0.05, 0.03}, 6e-3, 0, seed)).balls.size() > 0;
    const BallSearch deep = search(gains({0.05, 0.05, 0.02}, 6e-3, 1.5, seed));
    seen += deep.balls.size() > 0;
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
