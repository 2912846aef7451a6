// How far an image is told to see, and what the errors of lumps and beyond the grid are.
#include "imaging/image_sight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/block_mesh.h"

namespace hapsim {
namespace {

TEST(ImageSight, EndsWhereAFactorOfTwoIsOpen) {
  const TetMesh body = test::block_mesh({0.08, 0.08, 0.04}, 8, 8, 8, 1);
  const Vec3 press(0.04, 0.04, 0.04);
  ImageValues values;
  for (const auto& n : body.tets) {
    const Vec3 p = (body.nodes[n[0]] + body.nodes[n[1]] + body.nodes[n[2]] + body.nodes[n[3]]) / 4;
    values.modulus.push_back(1);
    values.log_std.push_back(0.02 / 1e-3 * (p - press).norm());  // 0.3537 at 17.7 mm
    values.resolution.push_back(0.5 * (p - press).norm());
  }
  EXPECT_NEAR(unresolved_log_std(), 0.35365, 1e-4);
  const ImageSight sight = image_sight(body, values, {press});
  EXPECT_NEAR(sight.reach, 0.0177, 0.003);
  EXPECT_NEAR(sight.at_reach, 0.5 * sight.reach, 1e-6);
  EXPECT_LT(sight.finest, sight.at_reach);
  EXPECT_NE(sight_words(sight).find("as far as"), std::string::npos);
  for (double& error : values.log_std) error = 1;
  EXPECT_NE(sight_words(image_sight(body, values, {press})).find("nowhere"), std::string::npos);
}

StiffnessImage small_image() {
  StiffnessImage image;
  image.field.grid = {Vec3(0, 0, 0), 0.01, {2, 2, 2}};
  image.field.log_ratio = Eigen::VectorXd::Constant(8, std::log(2.0));
  image.field.std_error = Eigen::VectorXd::LinSpaced(8, 0.1, 0.8);
  image.field.resolution = Eigen::VectorXd::Constant(8, 0.02);
  image.field.resolution[7] = std::numeric_limits<double>::infinity();
  return image;
}

TEST(ImageValues, AreUnsurestBeyondTheGrid) {
  const StiffnessImage image = small_image();
  EXPECT_NEAR(log_std_error(image, {0, 0, 0}), 0.1, 1e-12);
  EXPECT_NEAR(log_std_error(image, {0.005, 0, 0}), 0.15, 1e-12);
  EXPECT_NEAR(log_std_error(image, {-0.005, 0, 0}), 0.8, 1e-12);
  const ImageValues values =
      image_values(image, test::block_mesh({0.01, 0.01, 0.01}, 1, 1, 1, 1), 1e4);
  EXPECT_NEAR(values.modulus[0], 2e4, 1e-9);
  for (const double length : values.resolution) EXPECT_LE(length, 0.01 * std::sqrt(3.0) + 1e-12);
}

// A lump that is drawn in half of the draws twice as stiff and in the others four times.
TEST(ImageValues, HaveWhatALumpLeavesOpen) {
  StiffnessImage image = small_image();
  image.field.std_error.setConstant(0.1);
  Lump lump;
  lump.centre = Vec3(0.005, 0.005, 0.005);
  lump.radius = 0.002;
  lump.ratio = 2;
  lump.draws = {{lump.centre, 0.002, 2}, {lump.centre, 0.003, 4}};
  image.lumps = {lump};
  const double doubled = std::log(2.0);
  EXPECT_NEAR(modulus_ratio(image, lump.centre), 2, 1e-12);
  EXPECT_NEAR(log_std_error(image, lump.centre), std::sqrt(0.01 + 0.5 * doubled * doubled), 1e-12);
  EXPECT_NEAR(log_std_error(image, lump.centre + Vec3(0.0025, 0, 0)),
              std::sqrt(0.01 + 0.5 * 4 * doubled * doubled), 1e-12);
  EXPECT_NEAR(log_std_error(image, {0, 0, 0}), 0.1, 1e-12);
}

}  // namespace
}  // namespace hapsim
