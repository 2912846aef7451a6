// The tree's sums against a walk over all elements.
#include "contact/share_tree.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/feature_zone.h"
#include "solid/inhomogeneity.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

TEST(ShareTree, SumsWhatAWalkOverAllElementsSums) {
  const TetMesh mesh = test::block_mesh({0.06, 0.05, 0.03}, 9, 8, 6, 1);
  Random random(3);
  std::vector<Eigen::Matrix3d> share;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Eigen::Vector3d v(random.normal(), random.normal(), random.normal());
    share.push_back(v * v.transpose());
  }
  const ShareTree tree(mesh, share);
  for (int k = 0; k < 20; ++k) {
    const BodyFeature ball{Feature::kInclusion,
                           {0.06 * random.uniform(), 0.05 * random.uniform(),
                            0.03 * random.uniform(), 0.001 + 0.02 * random.uniform(), 3}};
    const LevelSet level = zone_level(ball, nullptr);
    const InsideShares all = inside_shares(mesh, level);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    std::vector<Eigen::Matrix3d> by(4, Eigen::Matrix3d::Zero());
    for (std::size_t t = 0; t < share.size(); ++t) {
      sum += all.share[t] * share[t];
      for (std::size_t v = 0; v < 4; ++v)
        by[v] += all.by_parameters(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(v)) *
                 share[t];
    }
    const ShareTree::Inside found = tree.inside(level, 4);
    EXPECT_LT((found.share - sum).norm(), 1e-10 * (1 + sum.norm()));
    for (std::size_t v = 0; v < 4; ++v)
      EXPECT_LT((found.by_parameters[v] - by[v]).norm(), 1e-10 * (1 + by[v].norm())) << v;
  }
}

TEST(ShareTree, OfNothingIsNothing) {
  const ShareTree tree;
  const BodyFeature ball{Feature::kInclusion, {0, 0, 0, 1, 3}};
  EXPECT_EQ(tree.inside(zone_level(ball, nullptr), 4).share, Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace hapsim
