// Residuals whose neighbours go together, and the choice between models by them.
#include "estimate/information.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// An autoregression of first order in each component, `presses` stretches of `n` samples.
Eigen::VectorXd autoregression(double a, Eigen::Index presses, Eigen::Index n, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd r(3 * presses * n);
  for (Eigen::Index p = 0; p < presses; ++p)
    for (Eigen::Index k = 0; k < 3; ++k) {
      double x = random.normal();
      for (Eigen::Index i = 0; i < n; ++i) {
        r[3 * (p * n + i) + k] = x;
        x = a * x + std::sqrt(1 - a * a) * random.normal();
      }
    }
  return r;
}

TEST(Information, AutocorrelationTimeOfAnAutoregression) {
  const std::vector<Eigen::Index> lengths(20, 2000);
  EXPECT_NEAR(autocorrelation_time(autoregression(0, 20, 2000, 1), lengths), 1, 0.02);
  // (1 + a) / (1 - a), less what has faded
  const double time = autocorrelation_time(autoregression(0.8, 20, 2000, 2), lengths);
  EXPECT_GT(time, 8);
  EXPECT_LT(time, 9.5);
}

TEST(Information, AComponentThatAloneErrsCountsAlone) {
  Eigen::VectorXd r = autoregression(0, 1, 3000, 3);
  EXPECT_NEAR(independent_samples(r, 1), 9000, 50);
  for (Eigen::Index i = 0; i < r.size(); ++i)
    if (i % 3 != 2) r[i] = 0;
  EXPECT_NEAR(independent_samples(r, 2), 1500, 1e-6);
}

// A mean that is not there is added by a fair share of draws only, although samples go together.
TEST(Information, TheCriterionKeepsAwayWhatIsNotThere) {
  int added = 0;
  const Eigen::Index presses = 4, n = 400;
  const std::vector<Eigen::Index> lengths(presses, n);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Eigen::VectorXd r = autoregression(0.9, presses, n, 100 + seed);
    Eigen::VectorXd centred = r;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto column = Eigen::seqN(k, r.size() / 3, 3);
      centred(column).array() -= r(column).mean();
    }
    const double memory = autocorrelation_time(centred, lengths);
    const double independent = independent_samples(centred, memory);
    added += information_criterion(centred.squaredNorm(), memory, independent, 3) <
             information_criterion(r.squaredNorm(), memory, independent, 0);
  }
  EXPECT_LE(added, 3);
}

}  // namespace
}  // namespace hapsim
