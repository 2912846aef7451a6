#include "cluster/division.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hapsim {
namespace {

// Normal samples about the centres in turn, errors 1; `scatter` times as wide as the errors say.
struct Samples {
  Eigen::MatrixXd x, s;
};
Samples make_samples(int n, const std::vector<double>& centres, double scatter,
                     std::uint64_t seed) {
  Random random(seed);
  Samples result{Eigen::MatrixXd(n, 2), Eigen::MatrixXd::Ones(n, 2)};
  for (int i = 0; i < n; ++i) {
    result.x(i, 0) = centres[i % centres.size()] + scatter * random.normal();
    result.x(i, 1) = scatter * random.normal();
  }
  return result;
}

int clusters(const Samples& samples, Linkage linkage, std::uint64_t seed) {
  Random random(seed);
  DivisionOptions options;
  options.simulations = 199;
  const auto label = natural_division(samples.x, samples.s, linkage, random, options).label;
  return 1 + *std::max_element(label.begin(), label.end());
}

TEST(NaturalDivision, OneClusterIsCalledOne) {
  // Errors that are right, and errors three times too small: the level is 5 %.
  for (const double scatter : {1.0, 3.0})
    for (const Linkage linkage : {Linkage::kAverage, Linkage::kWard}) {
      int wrong = 0;
      for (std::uint64_t seed = 1; seed <= 60; ++seed)
        wrong += clusters(make_samples(20, {0}, scatter, seed), linkage, seed) != 1;
      EXPECT_LE(wrong, 7) << scatter;  // 5 % of 60 is 3; more than 7 has a chance of 1 %
    }
}

TEST(NaturalDivision, ASlopeIsNoClusters) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    Samples samples = make_samples(20, {0}, 1, seed);
    for (int i = 0; i < 20; ++i) samples.x(i, 0) += 30 * random.uniform();
    wrong += clusters(samples, Linkage::kWard, seed) != 1;
  }
  EXPECT_LE(wrong, 7);
}

TEST(NaturalDivision, TwoAndThreeClustersAreCounted) {
  for (const Linkage linkage : {Linkage::kAverage, Linkage::kWard, Linkage::kComplete}) {
    int two = 0, three = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      two += clusters(make_samples(20, {0, 15}, 1, seed), linkage, seed) == 2;
      // Evenly spaced, where two of three hide the third from a test of two against one.
      three += clusters(make_samples(21, {0, 15, 30}, 1, seed), linkage, seed) == 3;
    }
    EXPECT_GE(two, 17);
    EXPECT_GE(three, 16);
  }
}

TEST(NaturalDivision, TheSameSeedGivesTheSame) {
  const Samples samples = make_samples(20, {0, 3}, 1, 4);
  Random a(7), b(7);
  const Division p = natural_division(samples.x, samples.s, Linkage::kWard, a);
  const Division q = natural_division(samples.x, samples.s, Linkage::kWard, b);
  EXPECT_EQ(p.label, q.label);
  EXPECT_EQ(p.tests.front().p_gaps, q.tests.front().p_gaps);
}

TEST(NaturalDivision, FewSamplesStayWhole) {
  EXPECT_EQ(clusters(make_samples(3, {0, 100}, 1, 1), Linkage::kWard, 1), 1);
  EXPECT_EQ(clusters(make_samples(1, {0}, 1, 1), Linkage::kWard, 1), 1);
}

}  // namespace
}  // namespace hapsim
