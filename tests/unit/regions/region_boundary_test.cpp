// Where the boundary between two regions lies, from what modulus each position asks for.
#include "regions/region_boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

using Plan = Eigen::Vector2d;

PlanGrid square_grid() {
  PlanGrid grid;
  grid.columns = grid.rows = 60;
  grid.step_x = grid.step_y = 2e-3;
  return grid;
}

// Positions 20 mm apart, roughly; each feels its surroundings as a flat punch does a half-space,
// with an energy that falls like the square of the distance beyond its rim, to a depth.
struct Pressed {
  PlanGrid grid = square_grid();
  std::vector<LocationSample> samples;
  std::vector<std::vector<float>> share;

  explicit Pressed(Random& random) {
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        const Vec3 p(0.02 * (i + 1) + 0.008 * (random.uniform() - 0.5),
                     0.02 * (j + 1) + 0.008 * (random.uniform() - 0.5), 0.04);
        std::vector<double> energy;
        double sum = 0;
        for (int c = 0; c < grid.columns * grid.rows; ++c) {
          const double r = (grid.centre(c) - p).head<2>().norm() / 0.004;
          energy.push_back(1 / (1 + std::pow(r, 4)));
          sum += energy.back();
        }
        share.emplace_back();
        for (const double e : energy) share.back().push_back(static_cast<float>(e / sum));
        samples.push_back({static_cast<int>(samples.size()), p, 1, 0});
      }
  }
  // Gains of a body of two moduli, with an error of one per cent.
  template <typename Inside>
  void press(double outside, double inside, const Inside& is_inside, Random& random) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double in = 0;
      for (std::size_t c = 0; c < share[i].size(); ++c)
        if (is_inside(Plan(grid.centre(static_cast<int>(c)).head<2>()))) in += share[i][c];
      const double log_gain = std::log(outside) + in * std::log(inside / outside);
      samples[i].gain = std::exp(log_gain + 0.01 * random.normal());
      samples[i].error = 0.01 * samples[i].gain;
    }
  }
};

// Share of the body's plan view that is on the wrong side.
template <typename Inside>
double misplaced(const RegionBoundary& boundary, const PlanGrid& grid, const Inside& is_inside) {
  int wrong = 0;
  for (int c = 0; c < grid.columns * grid.rows; ++c) {
    const Plan p = grid.centre(c).head<2>();
    wrong += (boundary.side(p) == 1) != is_inside(p);
  }
  return wrong / static_cast<double>(grid.columns * grid.rows);
}

TEST(RegionBoundary, StraightBentAndRoundOnesAreFound) {
  Random random(7);
  const auto straight = [](const Plan& p) { return p.x() + 0.4 * p.y() > 0.075; };
  const auto bent = [](const Plan& p) {
    return p.y() > 0.05 + 8 * (p.x() - 0.06) * (p.x() - 0.06);
  };
  const auto round = [](const Plan& p) { return (p - Plan(0.055, 0.065)).norm() < 0.03; };
  Pressed pressed(random);
  const auto check = [&](const char* name, const auto& inside) {
    pressed.press(1, 2.5, inside, random);
    const auto found = find_boundary(pressed.samples, pressed.share, pressed.grid);
    ASSERT_TRUE(found) << name;
    const double wrong = misplaced(*found, pressed.grid, inside);
    std::printf("%s: %.1f %% of the plan view on the wrong side, moduli %.3f and %.3f\n", name,
                100 * wrong, std::exp(found->log_gain[0]), std::exp(found->log_gain[1]));
    EXPECT_LT(wrong, 0.04) << name;
    EXPECT_NEAR(std::exp(found->log_gain[0]), 1, 0.05) << name;
    EXPECT_NEAR(std::exp(found->log_gain[1]), 2.5, 0.12) << name;
  };
  check("straight", straight);
  check("bent", bent);
  check("round", round);
}

// Soft within stiff: sides are told by modulus, not by shape.
TEST(RegionBoundary, TheSecondSideIsTheStiffer) {
  Random random(8);
  Pressed pressed(random);
  const auto soft = [](const Plan& p) { return p.x() > 0.055; };
  pressed.press(2, 1, soft, random);
  const auto found = find_boundary(pressed.samples, pressed.share, pressed.grid);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->side(Plan(0.02, 0.05)), 1);
  EXPECT_EQ(found->side(Plan(0.10, 0.05)), 0);
}

TEST(RegionBoundary, TooFewPositionsTellNone) {
  Random random(9);
  Pressed pressed(random);
  pressed.press(
      1, 2, [](const Plan& p) { return p.x() > 0.06; }, random);
  pressed.samples.resize(4);
  pressed.share.resize(4);
  EXPECT_FALSE(find_boundary(pressed.samples, pressed.share, pressed.grid));
}

}  // namespace
}  // namespace hapsim
