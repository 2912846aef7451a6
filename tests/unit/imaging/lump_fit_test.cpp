// Lumps sampled from made presses (made_presses.h), whose finite elements say otherwise than the
// linear signal.
#include "imaging/lump_fit.h"

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "imaging/ball_signal.h"
#include "imaging/lump_errors.h"
#include "imaging/lump_file.h"
#include "imaging/lump_signal.h"
#include "imaging/lump_solver.h"
#include "made_presses.h"

namespace hapsim {
namespace {

class LumpFitTest : public MadePresses {
 protected:
  // A lump counts half as much again as the linear signal has it, and saturates sooner.
  static double truly(double ratio) { return 1.5 * (ratio - 1) / (1 + 0.5 * (ratio - 1)); }
  Eigen::MatrixXd solved(const Vec3& centre, double radius,
                         const std::vector<double>& ratios) const {
    Eigen::MatrixXd result(J.rows(), static_cast<Eigen::Index>(ratios.size()));
    for (std::size_t r = 0; r < ratios.size(); ++r)
      result.col(static_cast<Eigen::Index>(r)) =
          truly(ratios[r]) * ball_signal(J, grid, centre, radius);
    return result;
  }
  LumpData data(const Eigen::VectorXd& gain) const {
    LumpData d;
    d.gain = gain;
    d.noise = Eigen::VectorXd::Constant(gain.size(), kNoise);
    for (int p = 0; p < static_cast<int>(gain.size()); ++p) d.position.push_back(p);
    d.free = Eigen::MatrixXd::Ones(gain.size(), 1);
    d.J = J;
    d.grid = grid;
    return d;
  }
  LumpPosterior fit(const LumpData& d, double ratio) const {
    const SignedDistance side(surface);
    Lump start;
    start.centre = {0.05, 0.05, 0.046};
    start.radius = 8e-3;
    start.ratio = ratio;
    return fit_lump(d, {contacts, side, kTool, kDepth}, start,
                    [&](const Vec3& c, double radius, const std::vector<double>& ratios,
                        const std::vector<int>&) { return solved(c, radius, ratios); });
  }
};

TEST_F(LumpFitTest, IntervalsHoldTheTruthAndTellTheRidge) {
  constexpr double kRadius = 6e-3, kRatio = 5;
  int held = 0, of = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Vec3 centre(0.052, 0.047, 0.049);
    const Lump lump = fit(data(gains(centre, kRadius, truly(kRatio), seed)), 2).lump;
    EXPECT_LT((lump.centre - centre).head<2>().norm(), 2e-3);
    EXPECT_NEAR(lump.depth, 0.011, 2e-3);
    for (const bool in :
         {lump.x.holds(centre.x()), lump.y.holds(centre.y()), lump.depth_in.holds(0.011),
          lump.radius_in.holds(kRadius), lump.ratio_in.holds(kRatio)}) {
      held += in;
      ++of;
    }
    EXPECT_GT(lump.ratio_in.high / lump.ratio_in.low, 4) << "size and modulus trade";
    EXPECT_GT(lump.radius_in.high / lump.radius_in.low, 1.2);
  }
  EXPECT_GE(held, of * 8 / 10) << "of " << of;
}

TEST_F(LumpFitTest, ASoftOneStaysSofter) {
  const Vec3 centre(0.045, 0.055, 0.05);
  const Lump lump = fit(data(gains(centre, 6e-3, truly(0.3), 2)), 0.5).lump;
  EXPECT_LT(lump.ratio_in.high, 1);
  EXPECT_TRUE(lump.ratio_in.holds(0.3));
  EXPECT_TRUE(lump.radius_in.holds(6e-3));
}

TEST_F(LumpFitTest, FindsHowMuchPositionsErrBesideTheirNoise) {
  LumpData d = data(gains({0.052, 0.047, 0.049}, 6e-3, truly(5), 3));
  Random random(5);
  constexpr double kMore = 0.012;
  for (Eigen::Index v = 0; v < d.gain.size(); ++v) d.gain[v] += kMore * random.normal();
  const LumpPosterior p = fit(d, 2);
  EXPECT_NEAR(p.error, kMore, 0.5 * kMore);
  EXPECT_TRUE(p.lump.depth_in.holds(0.011));
}

TEST_F(LumpFitTest, ErrorsAreWhiteAndKnowWhatIsFree) {
  LumpData d = data(Eigen::VectorXd::Zero(J.rows()));
  for (std::size_t v = 0; v < d.position.size(); ++v) d.position[v] = static_cast<int>(v / 2);
  const LumpErrors errors(d, 0.01, {});
  Random random(3);
  double sum = 0;
  constexpr int kDraws = 200;
  for (int k = 0; k < kDraws; ++k) {
    Eigen::VectorXd drawn(J.rows());
    for (Eigen::Index v = 0; v < drawn.size(); v += 2) {
      const double common = 0.01 * random.normal();
      for (const Eigen::Index w : {v, v + 1}) drawn[w] = common + kNoise * random.normal();
    }
    sum += errors.chi2(drawn) / kDraws;
  }
  EXPECT_NEAR(sum, static_cast<double>(errors.freedom()), 2);
  EXPECT_EQ(errors.freedom(), J.rows() - 1);
  EXPECT_NEAR(errors.chi2(d.free.col(0)), 0, 1e-15);
}

TEST_F(LumpFitTest, TheSignalIsThatOfTheElementsWhereTheyWereSolved) {
  LumpData d = data(Eigen::VectorXd::Zero(J.rows()));
  const Vec3 centre(0.05, 0.05, 0.048);
  const std::vector<double> ratios = solved_ratios(true);
  LumpSignal signal(d);
  signal.add(
      solved_ball(centre, 6e-3, true, solved(centre, 6e-3, ratios), signal.share(centre, 6e-3)));
  for (const double ratio : {3.0, 8.0, 15.0}) {
    const Eigen::VectorXd is = signal.at(centre, 6e-3, ratio);
    const Eigen::VectorXd should = solved(centre, 6e-3, {ratio});
    EXPECT_LT((is - should).norm(), 1e-9 * should.norm()) << ratio;
  }
}

TEST(BallSurface, HasTheBallsVolumeAndIsClosed) {
  const Surface ball = ball_surface({0.01, 0.02, 0.03}, 6e-3);
  EXPECT_EQ(ball.faces.size(), 80u);
  EXPECT_TRUE(is_closed(ball));
  EXPECT_NEAR(signed_volume(ball) / (4.0 / 3 * std::numbers::pi * std::pow(6e-3, 3)), 1, 1e-12);
}

TEST(LumpFile, HasARowALumpAndWhatWouldHaveBeenSeen) {
  StiffnessImage image;
  image.found.sight.push_back({6e-3, 5, 0.02});
  Lump lump;
  lump.centre = {0.01, 0.02, 0.03};
  lump.ratio = 4;
  lump.ratio_in = {2, 30};
  lump.chance = 1e-5;
  image.lumps.push_back(lump);
  std::ostringstream out;
  write_lumps(out, image);
  EXPECT_NE(out.str().find("# sight: 0.006 5 0.02\n"), std::string::npos);
  EXPECT_NE(out.str().find(",ratio,ratio_low,ratio_high,chance\n1,0.01,0,0,"), std::string::npos);
  EXPECT_NE(out.str().find(",4,2,30,1e-05\n"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
