#include "cluster/clustering.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

TEST(WardClusters, FindsTwoGroupsInAnyOrder) {
  const std::vector<double> values{1.0, 5.1, 1.1, 4.9, 0.9, 5.0};
  EXPECT_EQ(ward_clusters(values, std::vector<double>(6, 0.1), 2),
            (std::vector<int>{0, 1, 0, 1, 0, 1}));
}

TEST(WardClusters, OneClusterAndAsManyAsValues) {
  const std::vector<double> values{3, 1, 2};
  const std::vector<double> errors(3, 1.0);
  EXPECT_EQ(ward_clusters(values, errors, 1), (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(ward_clusters(values, errors, 3), (std::vector<int>{2, 0, 1}));
}

TEST(WardClusters, AnUncertainValueJoinsCheaply) {
  // 2.0 with a large error joins a neighbour before the two sure values do.
  const auto label = ward_clusters({0.0, 2.0, 1.0}, {0.01, 10.0, 0.01}, 2);
  EXPECT_NE(label[0], label[2]);
}

}  // namespace
}  // namespace hapsim
