// What stated intervals hold: a rig is recorded again and again with fresh poses and noise, and how
// often each true number lies inside is counted. Prints the figures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "calibrate/sensor_fit.h"
#include "calibrate/sensor_result.h"
#include "estimate/probability.h"
#include "unit/calibrate/rig.h"

namespace hapsim {
namespace {

struct Counted {
  double inside = 0, of = 0;
  double share() const { return inside / of; }
};

struct Figures {
  // Largest errors over all draws.
  double rotation = 0;         // [deg]
  double offset = 0;           // of the offset's size
  double weight = 0;           // of the weight
  double full_scale = 0;       // of the force, by what gains and cross-talk are wrong
  Counted numbers, all;        // each number by itself; all of the forces together (F region)
  double least = 1, most = 0;  // of one number over the draws
};

Vec3 vector_of(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd a(R);
  return a.angle() * a.axis();
}

Figures draw(const test::Rig& rig, const test::Rig& told, int draws, bool loads) {
  Figures figures;
  const Calibration truth = calibration_of(test::state_of(told));
  std::vector<Counted> one(kCalibratedNumbers);
  for (int seed = 1; seed <= draws; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const StaticPoses poses = test::recorded(rig, 30, random, loads);
    const SensorFit fit = fit_sensor(poses, {});
    EXPECT_TRUE(fit.determined);
    const Calibration c = calibration_of(fit, poses, {});
    for (std::size_t k = 0; k < kCalibratedNumbers; ++k) {
      const CalibratedValue& n = c.numbers[k];
      if (n.state != "fitted") continue;
      const double value = truth.numbers[k].value;
      one[k].inside += n.lower <= value && value <= n.upper;
      one[k].of += 1;
    }
    // One region for all that the forces tell.
    const Eigen::MatrixXd D = number_slopes(fit);
    Eigen::VectorXd miss(kCalibratedNumbers);
    for (std::size_t k = 0; k < kCalibratedNumbers; ++k)
      miss[static_cast<Eigen::Index>(k)] = c.numbers[k].value - truth.numbers[k].value;
    const Eigen::VectorXd x = D.completeOrthogonalDecomposition().solve(miss);
    std::vector<Eigen::Index> of_force;
    for (std::size_t k = 0; k < fit.unknowns.group.size(); ++k)
      if (fit.unknowns.group[k] != kOfTorque && fit.unknowns.group[k] != kOfTorqueDrift)
        of_force.push_back(static_cast<Eigen::Index>(k));
    const Eigen::MatrixXd own = fit.covariance(of_force, of_force);
    const Eigen::VectorXd off = x(of_force);
    const auto count = static_cast<double>(off.size());
    const double f = off.dot(own.ldlt().solve(off)) / count;
    figures.all.inside += fisher_upper(f, count, fit.force_freedom) > 0.05;
    figures.all.of += 1;

    figures.rotation = std::max(
        figures.rotation, vector_of(fit.state.rotation * told.R.transpose()).norm() * 180 / M_PI);
    figures.offset =
        std::max(figures.offset, (fit.state.offset - told.offset).norm() / told.offset.norm());
    figures.weight = std::max(figures.weight, std::abs(fit.state.mass / told.mass - 1));
    const Eigen::JacobiSVD<Eigen::MatrixXd> wrong(fit.state.crosstalk - told.C);
    figures.full_scale = std::max(figures.full_scale, wrong.singularValues()[0]);
  }
  for (const Counted& n : one) {
    if (n.of == 0) continue;
    figures.numbers.inside += n.inside;
    figures.numbers.of += n.of;
    figures.least = std::min(figures.least, n.share());
    figures.most = std::max(figures.most, n.share());
  }
  return figures;
}

void print(const std::string& what, const Figures& f) {
  fmt::print(
      "{:<34} rotation {:.3f} deg, offset {:.2f} %, weight {:.2f} %, cross-talk {:.2f} % of full "
      "scale at most; inside 95 %: numbers {:.1f} % (one by one {:.1f} to {:.1f} %), all of the "
      "forces together "
      "{:.1f} % of {:.0f} draws\n",
      what, f.rotation, 100 * f.offset, 100 * f.weight, 100 * f.full_scale, 100 * f.numbers.share(),
      100 * f.least, 100 * f.most, 100 * f.all.share(), f.all.of);
}

TEST(Coverage, ThirtyPosesWithAKnownWeight) {
  const test::Rig rig;
  const Figures f = draw(rig, rig, 200, true);
  print("known weight, 200 draws:", f);
  EXPECT_LT(f.rotation, 0.1);
  EXPECT_LT(f.offset, 0.01);
  EXPECT_LT(f.weight, 0.01);
  EXPECT_LT(f.full_scale, 0.005);
  EXPECT_NEAR(f.numbers.share(), 0.95, 0.02);
  // 200 draws tell a chance of 95 % to 1.5 %; of some thirty numbers one errs by 3 times that.
  EXPECT_NEAR(f.all.share(), 0.95, 0.05);
  EXPECT_GT(f.least, 0.89);
}

TEST(Coverage, ThirtyPosesWithTheToolAlone) {
  const test::Rig rig;
  const Figures f = draw(rig, test::of_mean_gain_one(rig), 200, false);
  print("no known weight, 200 draws:", f);
  EXPECT_LT(f.rotation, 0.1);
  EXPECT_LT(f.offset, 0.01);
  EXPECT_LT(f.weight, 0.01);
  EXPECT_LT(f.full_scale, 0.005);
  EXPECT_NEAR(f.numbers.share(), 0.95, 0.02);
  EXPECT_NEAR(f.all.share(), 0.95, 0.05);
}

TEST(Coverage, ManyDraws) {
  const test::Rig rig;
  const Figures f = draw(rig, rig, 2000, true);
  print("known weight, 2000 draws:", f);
  EXPECT_NEAR(f.numbers.share(), 0.95, 0.01);
  EXPECT_NEAR(f.all.share(), 0.95, 0.02);
  EXPECT_GT(f.least, 0.93);
  EXPECT_LT(f.most, 0.97);
}

// A robot whose orientation errs by 0.05 degrees: what no noise of the sensor is, and yet told.
TEST(Coverage, ARobotThatIsNotExact) {
  test::Rig rig;
  rig.pose_noise = 0.05 * M_PI / 180;
  const Figures f = draw(rig, rig, 200, true);
  print("poses off by 0.05 deg, 200 draws:", f);
  EXPECT_LT(f.rotation, 0.1);
  EXPECT_NEAR(f.numbers.share(), 0.95, 0.025);
}

}  // namespace
}  // namespace hapsim
