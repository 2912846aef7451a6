#include "nist.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimate/constrained.h"
#include "estimate/least_squares.h"
#include "estimate/multi_start.h"

namespace hapsim {
namespace {

using test::NistProblem;

LeastSquaresOptions exactly() {
  LeastSquaresOptions options;
  options.max_iterations = 2000;
  options.step_tolerance = 1e-12;
  options.decrease_tolerance = 1e-13;
  return options;
}

std::vector<Unknown> unknowns(const std::vector<double>& start) {
  std::vector<Unknown> result;
  for (const double v : start) result.push_back({v, -1e300, 1e300, std::abs(v), false});
  return result;
}

// Digits that agree, as NIST counts them.
double digits(double value, double certified) {
  return -std::log10(std::max(1e-15, std::abs(value - certified) / std::abs(certified)));
}

void expect_certified(const NistProblem& problem, const LeastSquaresResult& fit, double least) {
  ASSERT_TRUE(fit.converged) << fit.message;
  EXPECT_GT(digits(fit.sum_of_squares, problem.sum_of_squares), least);
  const double freedom = static_cast<double>(problem.x.size() - problem.value.size());
  for (std::size_t i = 0; i < problem.value.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_GT(digits(fit.x[k], problem.value[i]), least) << "parameter " << i + 1;
    const double error = std::sqrt(fit.covariance(k, k) * fit.sum_of_squares / freedom);
    EXPECT_GT(digits(error, problem.error[i]), least - 1) << "error " << i + 1;
  }
}

TEST(Nist, Misra1aFromBothStarts) {
  const NistProblem p = test::misra1a();
  for (const auto& start : p.starts)
    expect_certified(p, minimise(unknowns(start), p, exactly()), 6);
}

TEST(Nist, Mgh09FromTheNearStart) {
  const NistProblem p = test::mgh09();
  expect_certified(p, minimise(unknowns(p.starts[1]), p, exactly()), 5);
}

TEST(Nist, Mgh09WithinWideBoundsNeedsManyStarts) {
  // From NIST's far start one descent creeps along a valley without end.
  const NistProblem p = test::mgh09();
  std::vector<Unknown> wide;
  for (const double v : p.starts[0]) wide.push_back({v, 1e-3, 100, 1, true});
  Random random(1);
  expect_certified(
      p, minimise_from_many(latin_hypercube_starts(wide, 20, random), p, exactly()).best, 5);
}

TEST(Nist, Lanczos3FromBothStarts) {
  const NistProblem p = test::lanczos3();
  for (const auto& start : p.starts)
    expect_certified(p, minimise(unknowns(start), p, exactly()), 5);
}

TEST(Nist, Lanczos3WithRatesKeptApart) {
  // b2 < b4 < b6 by a factor 1.2 at least, which the certified rates are: nothing binds.
  const NistProblem p = test::lanczos3();
  std::vector<Unknown> start;
  for (std::size_t i = 0; i < 6; ++i)
    start.push_back(i % 2 == 0 ? Unknown{p.starts[1][i], -100, 100, 1, false}
                               : Unknown{p.starts[1][i], 1e-3, 1e3, 1, true});
  LeastSquaresOptions options;
  options.max_iterations = 3000;
  const ResidualFunction whitened = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                        Eigen::MatrixXd* J) {
    p(x, r, J);  // to variance 1: the certified residual deviation is 3e-5
    r *= 1 / 2.9923e-05;
    if (J != nullptr) *J *= 1 / 2.9923e-05;
  };
  const ConstrainedResult result =
      minimise_constrained(start, keep_apart(6, {1, 3, 5}, 1.2), whitened, options);
  ASSERT_TRUE(result.fit.converged) << result.fit.message;
  EXPECT_FALSE(result.active[0] || result.active[1]);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(result.fit.x[k], p.value[i], 0.02 * p.error[i]);
    EXPECT_NEAR(std::sqrt(result.fit.covariance(k, k)), p.error[i], 0.02 * p.error[i]);
  }
}

TEST(Nist, ManyStartsFindTheDeepestValley) {
  const NistProblem p = test::misra1a();
  std::vector<Unknown> wide{{1, 1e-3, 1e6, 1, true}, {1, 1e-9, 1e3, 1, true}};
  Random random(2);
  const MultiStartResult found =
      minimise_from_many(latin_hypercube_starts(wide, 20, random), p, exactly());
  expect_certified(p, found.best, 6);
  EXPECT_EQ(found.starts, 20);
  EXPECT_GE(found.agreeing, 2);
}

}  // namespace
}  // namespace hapsim
