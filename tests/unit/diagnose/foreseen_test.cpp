// What samples foretell of samples, whatever its shape.
#include "diagnose/foreseen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace hapsim {
namespace {

constexpr Eigen::Index kRows = 600;
const std::vector<Eigen::Index> kLengths{200, 150, 250};

Eigen::VectorXd white_rows(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(3 * kRows, [&] { return normal(random); });
}

// As a share of the squares.
double foreseen_share(const Eigen::VectorXd& r) {
  return foreseen_squares(r, kLengths) / r.squaredNorm();
}

TEST(Foreseen, WhiteNoiseIsNot) {
  double sum = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) sum += foreseen_share(white_rows(seed));
  EXPECT_LT(sum / 20, 0.003);
}

// Of a sum of sines without noise all is, at four samples a period, where neighbours are not
// correlated, too; beside noise nearly what is theirs.
TEST(Foreseen, AHumIsAtAnyFrequency) {
  for (const double period : {2.3, 4.0, 17.0}) {
    Eigen::VectorXd r(3 * kRows);
    for (Eigen::Index i = 0; i < r.size(); ++i)
      r[i] = std::sin(2 * std::numbers::pi * static_cast<double>(i / 3) / period);
    EXPECT_GT(foreseen_share(r), 0.97) << period;
    const Eigen::VectorXd noisy = 4 * r + white_rows(3);
    EXPECT_GT(foreseen_share(noisy), 0.7) << period;
    EXPECT_LT(foreseen_share(noisy), 8.0 / 9) << period;  // 4^2 / 2 of 4^2 / 2 + 1
  }
}

// rho^2 of the squares of x_i = rho x_(i-1) + e_i, of either sign.
TEST(Foreseen, OfAMarkovChainItIsTheSquareOfTheCorrelation) {
  for (const double rho : {0.6, -0.6}) {
    double sum = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
      Eigen::VectorXd r = white_rows(seed);
      for (Eigen::Index i = 3; i < r.size(); ++i) r[i] += rho * r[i - 3];
      sum += foreseen_share(r);
    }
    EXPECT_NEAR(sum / 10, rho * rho, 0.03) << rho;
  }
}

TEST(Foreseen, ShortStretchesSayNothing) {
  EXPECT_EQ(foreseen_squares(Eigen::VectorXd::Ones(3 * 32), {16, 16}), 0);
  EXPECT_EQ(foreseen_squares(Eigen::VectorXd::Zero(3 * 32), {32}), 0);
}

}  // namespace
}  // namespace hapsim
