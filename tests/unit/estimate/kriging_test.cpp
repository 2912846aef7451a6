#include "estimate/kriging.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

struct Sampled {
  KrigingCoordinates places;
  Eigen::MatrixXd values;
};

double truth(double x, double y) {
  return std::sin(3 * x) * std::cos(2 * y);
}

Sampled draw(int n, std::uint64_t seed) {
  Random random(seed);
  Sampled s{{Eigen::MatrixXd(n, 3), {2, 3}}, Eigen::MatrixXd(n, 2)};
  for (int i = 0; i < n; ++i) {
    const double x = 2 * random.uniform(), y = 2 * random.uniform();
    s.places.rows.row(i) << x, y, x + y;
    s.values.row(i) << truth(x, y), truth(y, x);
  }
  return s;
}

Sampled without(const Sampled& s, Eigen::Index left) {
  const Eigen::Index n = s.values.rows() - 1;
  Sampled r{{Eigen::MatrixXd(n, 3), {2, 3}}, Eigen::MatrixXd(n, 2)};
  for (Eigen::Index i = 0; i < n; ++i) {
    r.places.rows.row(i) = s.places.rows.row(i < left ? i : i + 1);
    r.values.row(i) = s.values.row(i < left ? i : i + 1);
  }
  return r;
}

TEST(Kriging, LeavesOutInClosedFormWhatBruteForceDoes) {
  const Sampled s = draw(40, 1);
  const Kriging all(s.places, s.values);
  for (const Eigen::Index i : {0, 7, 39}) {
    const Sampled rest = without(s, i);
    const Kriging others(rest.places, rest.values, &all.scales());
    const Eigen::MatrixXd c = others.covariance(s.places.rows.row(i));
    EXPECT_LT((others.mean(c) - s.values.row(i) - all.left_out().row(i)).norm(), 1e-6);
    EXPECT_NEAR(others.posterior_variance(c)[0] + all.nugget(), all.left_out_variance()[i], 1e-6);
  }
}

TEST(Kriging, FollowsASmoothFunctionAndKnowsHowWell) {
  const Sampled s = draw(120, 2), other = draw(400, 3);
  const Kriging model(s.places, s.values);
  const Eigen::MatrixXd c = model.covariance(other.places.rows);
  const Eigen::MatrixXd error = model.mean(c) - other.values;
  const Eigen::VectorXd variance =
      model.variance() * (model.posterior_variance(c).array() + model.nugget()).matrix();
  EXPECT_LT(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.02);
  int covered = 0;
  for (Eigen::Index i = 0; i < error.rows(); ++i)
    for (Eigen::Index k = 0; k < 2; ++k)
      covered += std::abs(error(i, k)) <= 1.96 * std::sqrt(variance[i]) ? 1 : 0;
  EXPECT_GT(covered, 0.9 * static_cast<double>(error.size()));
}

}  // namespace
}  // namespace hapsim
