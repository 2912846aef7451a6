#include "cluster/dendrogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"

namespace hapsim {
namespace {

constexpr Linkage kAll[] = {Linkage::kSingle, Linkage::kComplete, Linkage::kAverage,
                            Linkage::kWard};

Eigen::MatrixXd distances_of(const Eigen::MatrixXd& x) {
  return scaled_distances(x, Eigen::MatrixXd::Ones(x.rows(), x.cols()));
}

Eigen::MatrixXd random_points(int n, int d, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd x(n, d);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < d; ++c) x(i, c) = random.normal();
  return x;
}

std::vector<double> heights(const Dendrogram& tree) {
  std::vector<double> h;
  for (const Merge& m : tree.merges) h.push_back(m.height);
  return h;
}

// Straight from the definitions of the linkages: join the two nearest clusters, n^3.
std::vector<double> naive_heights(const Eigen::MatrixXd& x, Linkage linkage) {
  std::vector<std::vector<int>> clusters;
  for (int i = 0; i < x.rows(); ++i) clusters.push_back({i});
  const auto between = [&](const std::vector<int>& a, const std::vector<int>& b) {
    if (linkage == Linkage::kWard) {
      Eigen::RowVectorXd ma = Eigen::RowVectorXd::Zero(x.cols()), mb = ma;
      for (const int i : a) ma += x.row(i) / static_cast<double>(a.size());
      for (const int i : b) mb += x.row(i) / static_cast<double>(b.size());
      const double na = static_cast<double>(a.size()), nb = static_cast<double>(b.size());
      return std::sqrt(2 * na * nb / (na + nb)) * (ma - mb).norm();
    }
    double least = 1e300, most = 0, sum = 0;
    for (const int i : a)
      for (const int j : b) {
        const double d = (x.row(i) - x.row(j)).norm();
        least = std::min(least, d);
        most = std::max(most, d);
        sum += d / static_cast<double>(a.size() * b.size());
      }
    return linkage == Linkage::kSingle ? least : linkage == Linkage::kComplete ? most : sum;
  };
  std::vector<double> result;
  while (clusters.size() > 1) {
    std::size_t p = 0, q = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < clusters.size(); ++i)
      for (std::size_t j = i + 1; j < clusters.size(); ++j)
        if (const double d = between(clusters[i], clusters[j]); d < least) least = d, p = i, q = j;
    result.push_back(least);
    clusters[p].insert(clusters[p].end(), clusters[q].begin(), clusters[q].end());
    clusters.erase(clusters.begin() + static_cast<long>(q));
  }
  return result;
}

TEST(Dendrogram, HeightsOfFourNumbers) {
  const Eigen::MatrixXd x = Eigen::Vector4d(0, 1, 3, 7);
  const auto expect = [&](Linkage linkage, double second, double third) {
    const auto h = heights(agglomerate(distances_of(x), linkage));
    ASSERT_EQ(h.size(), 3U);
    EXPECT_DOUBLE_EQ(h[0], 1);
    EXPECT_NEAR(h[1], second, 1e-12);
    EXPECT_NEAR(h[2], third, 1e-12);
  };
  expect(Linkage::kSingle, 2, 4);
  expect(Linkage::kComplete, 3, 7);
  expect(Linkage::kAverage, 2.5, 17.0 / 3);
  expect(Linkage::kWard, std::sqrt(4.0 / 3) * 2.5, std::sqrt(1.5) * 17.0 / 3);
}

TEST(Dendrogram, ChainsGiveTheTreeOfTheDefinition) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Eigen::MatrixXd x = random_points(40, 2, seed);
    for (const Linkage linkage : kAll) {
      const auto fast = heights(agglomerate(distances_of(x), linkage));
      const auto slow = naive_heights(x, linkage);
      ASSERT_EQ(fast.size(), slow.size());
      for (std::size_t m = 0; m < fast.size(); ++m) EXPECT_NEAR(fast[m], slow[m], 1e-9);
    }
  }
}

TEST(Dendrogram, EqualSamplesAndASingleOneAreTrees) {
  for (const Linkage linkage : kAll) {
    const Dendrogram tree = agglomerate(Eigen::MatrixXd::Zero(6, 6), linkage);
    ASSERT_EQ(tree.merges.size(), 5U);
    EXPECT_EQ(tree.merges.back().size, 6);
    EXPECT_TRUE(agglomerate(Eigen::MatrixXd::Zero(1, 1), linkage).merges.empty());
  }
  EXPECT_EQ(leaf_order(agglomerate(Eigen::MatrixXd::Zero(1, 1), Linkage::kWard)),
            (std::vector<int>{0}));
}

TEST(Dendrogram, CutsIntoAnyNumber) {
  const Eigen::MatrixXd x = (Eigen::VectorXd(5) << 9, 0, 10, 1, 30).finished();
  const Dendrogram tree = agglomerate(distances_of(x), Linkage::kAverage);
  EXPECT_EQ(cut(tree, 1), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(cut(tree, 2), (std::vector<int>{0, 0, 0, 0, 1}));
  EXPECT_EQ(cut(tree, 3), (std::vector<int>{0, 1, 0, 1, 2}));
  EXPECT_EQ(cut(tree, 5), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(Dendrogram, CopheneticCorrelationIsOneForADistanceThatIsATree) {
  // Two pairs, 1 apart within and 4 between: every linkage keeps all distances but Ward.
  Eigen::MatrixXd d = Eigen::MatrixXd::Constant(4, 4, 4);
  for (int i = 0; i < 4; ++i) d(i, i) = 0, d(i, i ^ 1) = 1;
  for (const Linkage linkage : {Linkage::kSingle, Linkage::kComplete, Linkage::kAverage}) {
    const Dendrogram tree = agglomerate(d, linkage);
    EXPECT_TRUE(cophenetic_distances(tree).isApprox(d));
    EXPECT_NEAR(cophenetic_correlation(d, tree), 1, 1e-12);
  }
}

TEST(Dendrogram, CopheneticCorrelationByHand) {
  // 0, 1, 3 by average: d = 1, 3, 2 and l = 1, 2.5, 2.5.
  const Eigen::MatrixXd d = distances_of(Eigen::Vector3d(0, 1, 3));
  EXPECT_NEAR(cophenetic_correlation(d, agglomerate(d, Linkage::kAverage)), std::sqrt(0.75), 1e-12);
}

TEST(Dendrogram, InconsistencyComparesWithTheMergesBelow) {
  const Dendrogram tree =
      agglomerate(distances_of(Eigen::Vector4d(0, 1, 10, 12)), Linkage::kSingle);
  const auto c = inconsistency(tree);
  EXPECT_EQ(c[0], 0);
  EXPECT_EQ(c[1], 0);
  EXPECT_NEAR(c[2], (9 - 4.0) / std::sqrt(19), 1e-12);  // 1, 2, 9: mean 4, variance 19
}

TEST(Dendrogram, AnUncertainSampleIsNearToAll) {
  const Eigen::MatrixXd x = Eigen::Vector3d(0, 1, 2), s = Eigen::Vector3d(0.1, 10, 0.1);
  const Eigen::MatrixXd d = scaled_distances(x, s);
  EXPECT_NEAR(d(0, 2), 20, 1e-12);
  EXPECT_LT(d(0, 1), 0.2);
}

}  // namespace
}  // namespace hapsim
