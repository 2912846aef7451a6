#include "mesh/quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

TetMesh one_tet(const std::vector<Vec3>& corners) {
  TetMesh mesh;
  mesh.nodes = corners;
  mesh.tets.push_back({0, 1, 2, 3, -1, -1, -1, -1, -1, -1});
  mesh.region = {0};
  mesh.fixed.assign(4, 0);
  return mesh;
}

TEST(Quality, RegularTetrahedron) {
  const TetQuality q = tet_quality(one_tet({{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}));
  EXPECT_EQ(q.inverted, 0u);
  EXPECT_NEAR(q.volume, 8.0 / 3, 1e-12);
  EXPECT_NEAR(q.radius_edge.median, std::sqrt(6.0) / 4, 1e-12);
  EXPECT_NEAR(q.smallest_dihedral_deg.median, std::acos(1.0 / 3) * 180 / M_PI, 1e-9);
  EXPECT_NEAR(q.largest_dihedral_deg, std::acos(1.0 / 3) * 180 / M_PI, 1e-9);
}

TEST(Quality, CornerOfACube) {
  const TetQuality q = tet_quality(one_tet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_NEAR(q.radius_edge.maximum, std::sqrt(3.0) / 2, 1e-12);
  EXPECT_NEAR(q.largest_dihedral_deg, 90, 1e-9);
  EXPECT_NEAR(q.smallest_dihedral_deg.minimum, std::acos(1 / std::sqrt(3.0)) * 180 / M_PI, 1e-9);
}

TEST(Quality, CountsAndPlacesTheInverted) {
  TetMesh mesh = one_tet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  mesh.tets.push_back({0, 2, 1, 3, -1, -1, -1, -1, -1, -1});
  const TetQuality q = tet_quality(mesh);
  EXPECT_EQ(q.inverted, 1u);
  EXPECT_EQ(q.worst, 1u);
  EXPECT_NEAR((q.worst_place - Vec3(0.25, 0.25, 0.25)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace hapsim
