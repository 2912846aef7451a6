// The filter against least squares over the whole history, late observations against early ones.
#include "estimate/delayed_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "base/random.h"
#include "estimate/simplex_search.h"

namespace hapsim {
namespace {

using Filter = DelayedFilter<2>;

struct Observation {
  double t, arrives, z;
  Filter::Vector h;
};

std::vector<Observation> observations(Random& random, double late) {
  std::vector<Observation> all;
  for (int i = 1; i < 60; ++i) {
    const double t = 0.1 * i;
    all.push_back({t, t + late * random.uniform(), random.normal(), {1, std::sin(3 * t)}});
  }
  return all;
}

const Filter::Vector kWalk(1e-3, 4e-4);
const Filter::Matrix kMove = (Filter::Matrix() << 0.999, 0.02, 0, 1).finished();

// Steps of 10 ms with every observation at its arrival.
Filter run(std::vector<Observation> all) {
  Filter filter(2000);
  filter.restart(0, Filter::Vector(0.3, -0.2), Filter::Matrix::Identity());
  std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.arrives < b.arrives; });
  std::size_t next = 0;
  for (int i = 1; i <= 800; ++i) {
    filter.predict(0.01 * i, kMove, kWalk);
    for (; next < all.size() && all[next].arrives <= 0.01 * i + 1e-9; ++next)
      EXPECT_TRUE(filter.observe(all[next].t - 1e-9, all[next].h, all[next].z, 0.04).taken);
  }
  EXPECT_EQ(next, all.size());
  return filter;
}

TEST(DelayedFilter, LateAndUnorderedObservationsAreThoseInTime) {
  Random random(4);
  std::vector<Observation> all = observations(random, 1.7);
  const Filter late = run(all);
  for (Observation& o : all) o.arrives = o.t;
  const Filter early = run(all);
  EXPECT_EQ(late.x(), early.x());
  EXPECT_EQ(late.P(), early.P());
}

// The state at the end and its covariance are those of generalised least squares over everything:
// prior, transitions and observations in one normal matrix, which knows nothing of filters.
TEST(DelayedFilter, IsLeastSquaresOverTheWholeHistory) {
  Random random(5);
  const int steps = 80;
  const Eigen::Index size = 2 * (steps + 1);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  const auto add = [&](const Eigen::VectorXd& row, double z, double variance) {
    A += row * row.transpose() / variance;
    b += row * z / variance;
  };
  Filter filter(200);
  const Filter::Vector start(0.3, -0.2);
  filter.restart(0, start, Filter::Matrix::Identity());
  for (int k = 0; k < 2; ++k) add(Eigen::VectorXd::Unit(size, k), start[k], 1);
  for (int i = 1; i <= steps; ++i) {
    filter.predict(0.1 * i, kMove, kWalk);
    for (int k = 0; k < 2; ++k) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
      row[2 * i + k] = 1;
      row.segment<2>(2 * i - 2) = -kMove.row(k);
      add(row, 0, kWalk[k]);
    }
  }
  for (int i = 3; i <= steps; i += 4) {
    const Filter::Vector h(1, std::cos(0.3 * i));
    const double z = random.normal();
    EXPECT_TRUE(filter.observe(0.1 * i - 1e-9, h, z, 0.04).taken);
    Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
    row.segment<2>(2 * i) = h;
    add(row, z, 0.04);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solved(A);
  const Eigen::VectorXd x = solved.solve(b);
  const Eigen::MatrixXd P = solved.solve(Eigen::MatrixXd::Identity(size, size));
  EXPECT_LT((filter.x() - x.tail<2>()).norm(), 1e-9);
  EXPECT_LT((filter.P() - P.bottomRightCorner<2, 2>()).norm(), 1e-9);
}

// Innovations of data that are as the filter thinks have the variance that it says.
TEST(DelayedFilter, InnovationsAreConsistent) {
  Random random(6);
  double nis = 0;
  int count = 0;
  for (int run_number = 0; run_number < 40; ++run_number) {
    Filter filter(50);
    Filter::Vector truth(random.normal(), random.normal());
    filter.restart(0, Filter::Vector::Zero(), Filter::Matrix::Identity());
    for (int i = 1; i <= 300; ++i) {
      truth = kMove * truth;
      for (int k = 0; k < 2; ++k) truth[k] += std::sqrt(kWalk[k]) * random.normal();
      filter.predict(0.1 * i, kMove, kWalk);
      if (i % 5 != 0) continue;
      const Filter::Vector h(1, std::cos(0.2 * i));
      nis += filter.observe(0.1 * i, h, h.dot(truth) + 0.2 * random.normal(), 0.04).nis();
      ++count;
    }
  }
  EXPECT_NEAR(nis / count, 1, 4 * std::sqrt(2.0 / count));
}

TEST(DelayedFilter, RefusesWhatIsOlderThanItRemembers) {
  Filter filter(20);
  filter.restart(0, Filter::Vector::Zero(), Filter::Matrix::Identity());
  for (int i = 1; i <= 100; ++i) filter.predict(0.01 * i, kMove, kWalk);
  EXPECT_FALSE(filter.observe(0.5, {1, 0}, 1, 1).taken);
  EXPECT_FALSE(filter.observe(1.5, {1, 0}, 1, 1).taken);  // not yet
  EXPECT_TRUE(filter.observe(0.95, {1, 0}, 1, 1).taken);
}

TEST(SimplexSearch, FindsTheMinimumOfACurvedValley) {
  const auto rosenbrock = [](const Eigen::VectorXd& x) {
    return 100 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1 - x[0], 2);
  };
  SimplexSearchOptions options;
  options.tolerance = 1e-7;
  options.most_evaluations = 5000;
  const SimplexSearchResult found = simplex_search(Eigen::Vector2d(-1.2, 1), rosenbrock, options);
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.x - Eigen::Vector2d(1, 1)).norm(), 1e-5);
}

}  // namespace
}  // namespace hapsim
