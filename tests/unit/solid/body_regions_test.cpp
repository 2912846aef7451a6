// The numbered tetrahedra of a body as regions: which region a point is of, and how much of an
// element of another mesh.
#include "solid/body_regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/block_mesh.h"

namespace hapsim {
namespace {

const Vec3 kSize(0.06, 0.05, 0.03);

// Numbered by what `region_of` says of each centre.
template <class RegionOf>
TetMesh numbered(TetMesh mesh, const RegionOf& region_of) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 4; ++k) centre += mesh.nodes[mesh.tets[t][k]] / 4;
    mesh.region[t] = region_of(centre);
  }
  return mesh;
}

std::map<int, double> volumes(const BodyRegions& regions, const TetMesh& mesh) {
  std::map<int, double> volume;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double sum = 0;
    for (const BodyRegions::Part& p : regions.parts(mesh, t)) {
      EXPECT_GT(p.share, 0);
      sum += p.share;
      volume[p.region] += p.share * tet_volume(mesh, t);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  return volume;
}

std::map<int, double> own_volumes(const TetMesh& mesh) {
  std::map<int, double> volume;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) volume[mesh.region[t]] += tet_volume(mesh, t);
  return volume;
}

TEST(BodyRegions, NoneWhereAllAreOfRegionZero) {
  TetMesh mesh = test::block_mesh(kSize, 3, 3, 3, 1);
  EXPECT_EQ(BodyRegions::of(mesh), nullptr);
  mesh.region.clear();
  EXPECT_EQ(BodyRegions::of(mesh), nullptr);
}

TEST(BodyRegions, AllOfOneNumberIsNoBoundary) {
  TetMesh mesh = test::block_mesh(kSize, 3, 3, 3, 1);
  mesh.region.assign(mesh.tets.size(), 4);
  const auto regions = BodyRegions::of(mesh);
  ASSERT_NE(regions, nullptr);
  EXPECT_EQ(regions->numbers(), std::vector<int>{4});
  EXPECT_EQ(regions->at({0.01, 0.01, 0.01}), 4);
  EXPECT_EQ(regions->at({0.2, 0, 0}), 4);
  EXPECT_NEAR(volumes(*regions, test::block_mesh(kSize, 4, 5, 4, 1))[4], kSize.prod(), 1e-15);
  EXPECT_GT(regions->level(0)({0.01, 0.01, 0.01}).value, 1);
  EXPECT_LT(regions->level(4)({0.01, 0.01, 0.01}).value, -1);
}

TEST(BodyRegions, APointIsOfItsTetrahedron) {
  const TetMesh mesh = numbered(test::block_mesh(kSize, 6, 5, 4, 1, 0.3),
                                [](const Vec3& p) { return p.x() > 0.03; });
  const BodyRegions regions(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Vec3 p = 0.4 * mesh.nodes[mesh.tets[t][0]] + 0.3 * mesh.nodes[mesh.tets[t][1]] +
                   0.2 * mesh.nodes[mesh.tets[t][2]] + 0.1 * mesh.nodes[mesh.tets[t][3]];
    EXPECT_EQ(regions.at(p), mesh.region[t]);
    EXPECT_EQ(regions.level(1)(p).value < 0, mesh.region[t] == 1);
  }
  // Outside: that of the nearest face.
  EXPECT_EQ(regions.at({0.07, 0.02, 0.01}), 1);
  EXPECT_EQ(regions.at({0.01, 0.02, 0.04}), 0);
}

// A plane through another mesh cuts its elements exactly; so do planes that meet.
TEST(BodyRegions, SharesOfFlatBoundariesAreExact) {
  const TetMesh mesh = numbered(test::block_mesh(kSize, 6, 5, 3, 1),
                                [](const Vec3& p) { return p.x() > 0.03 ? 2 : 0; });
  const auto volume = volumes(BodyRegions(mesh), test::block_mesh(kSize, 7, 8, 5, 1, 0.3));
  EXPECT_NEAR(volume.at(2) / kSize.prod(), 0.5, 1e-12);
  EXPECT_NEAR(volume.at(0) / kSize.prod(), 0.5, 1e-12);
}

// Three regions that touch, one of them at the surface and one inside another: their volumes on
// finer meshes tend to their own.
TEST(BodyRegions, SharesTendToTheRegionsVolumes) {
  const TetMesh mesh = numbered(test::block_mesh(kSize, 6, 5, 6, 1), [](const Vec3& p) {
    if (std::abs(p.x() - 0.03) < 0.01 && std::abs(p.y() - 0.025) < 0.015 && p.z() > 0.01)
      return p.x() < 0.03 ? 1 : 2;  // both to the top
    return std::abs(p.x() - 0.03) < 0.02 && std::abs(p.y() - 0.025) < 0.02 ? 3 : 0;
  });
  const BodyRegions regions(mesh);
  const auto own = own_volumes(mesh);
  double coarse = 0;
  for (const int n : {7, 14}) {
    double worst = 0;
    for (const auto& [region, volume] :
         volumes(regions, test::block_mesh(kSize, n, n - 1, n - 2, 1, 0.2)))
      worst = std::max(worst, std::abs(volume / own.at(region) - 1));
    EXPECT_LT(worst, n == 7 ? 0.02 : 0.005);
    if (n == 14) {
      EXPECT_LT(worst, coarse / 2);
    }
    coarse = worst;
  }
}

// What grows takes of its neighbours as a larger region would have, and its derivatives are those
// of differences; a region that touches two others, one of which grows as well.
TEST(BodyRegions, GrowthMovesTheBoundary) {
  const auto boxes = [](double more) {
    return numbered(test::block_mesh(kSize, 30, 25, 15, 1), [&](const Vec3& p) {
      const Vec3 q = (p - Vec3(0.03, 0.024, 0.014)).cwiseAbs();
      return q.x() < 0.01 + more && q.y() < 0.008 + more && q.z() < 0.006 + more ? 1 : 0;
    });
  };
  const BodyRegions small(boxes(0)), large(boxes(0.002));
  const TetMesh mesh = test::block_mesh(kSize, 13, 12, 9, 1, 0.2);
  const double wanted = volumes(large, mesh).at(1);
  double grown = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const BodyRegions::Part& p : small.parts(mesh, t, {{1, 0.002}}))
      if (p.region == 1) grown += p.share * tet_volume(mesh, t);
  EXPECT_NEAR(grown / wanted, 1, 0.03);  // rounded at its edges
  EXPECT_EQ(small.at({0.0415, 0.024, 0.014}), 0);
  EXPECT_EQ(small.at({0.0415, 0.024, 0.014}, {{1, 0.002}}), 1);
  EXPECT_EQ(small.at({0.0385, 0.024, 0.014}, {{1, -0.002}}), 0);

  const BodyRegions three(numbered(test::block_mesh(kSize, 6, 5, 6, 1), [](const Vec3& p) {
    return p.z() > 0.02 ? 3 : p.x() > 0.03 && p.y() > 0.02 ? 1 : 0;
  }));
  const TetMesh coarse = test::block_mesh(kSize, 9, 8, 6, 1, 0.2);
  for (const auto& growth : std::vector<std::vector<BodyRegions::Growth>>{
           {{1, 0.0013}}, {{1, -0.0017}}, {{1, 0.0008}, {3, -0.0011}}}) {
    for (std::size_t k = 0; k < growth.size(); ++k) {
      const auto moved = [&](double step) {
        auto other = growth;
        other[k].by += step;
        std::map<int, double> volume;
        for (std::size_t t = 0; t < coarse.tets.size(); ++t) {
          double sum = 0;
          for (const BodyRegions::Part& p : three.parts(coarse, t, other)) {
            volume[p.region] += p.share * tet_volume(coarse, t);
            sum += p.share;
          }
          EXPECT_NEAR(sum, 1, 1e-12);
        }
        return volume;
      };
      std::map<int, double> slope;
      for (std::size_t t = 0; t < coarse.tets.size(); ++t)
        for (const BodyRegions::Part& p : three.parts(coarse, t, growth))
          slope[p.region] += p.by_growth[k] * tet_volume(coarse, t);
      auto up = moved(1e-6), down = moved(-1e-6);
      double area = 0;
      for (const auto& [region, by] : slope) area = std::max(area, std::abs(by));
      EXPECT_GT(area, 1e-4);
      for (const auto& [region, by] : slope)
        EXPECT_NEAR((up[region] - down[region]) / 2e-6, by, 2e-3 * area) << region << ' ' << k;
    }
  }
}

// Closed and outward, of the region's own volume; one within another, too. None where a boundary
// ends at the body's surface.
TEST(BodyRegions, EnclosedBoundariesAreClosedSurfaces) {
  const TetMesh block = test::block_mesh(kSize, 12, 10, 6, 1);
  const Vec3 middle = kSize / 2;
  const TetMesh two = numbered(block, [&](const Vec3& p) {
    const double r = (p - middle).cwiseQuotient(kSize).cwiseAbs().maxCoeff();
    return r < 0.15 ? 2 : r < 0.35 ? 5 : 0;
  });
  double inner = 0, both = 0;
  for (std::size_t t = 0; t < two.tets.size(); ++t) {
    if (two.region[t] == 2) inner += tet_volume(two, t);
    if (two.region[t] != 0) both += tet_volume(two, t);
  }
  ASSERT_GT(inner, 0);
  const std::vector<Surface> parts = BodyRegions(two).enclosed();
  ASSERT_EQ(parts.size(), 2u);
  for (const Surface& part : parts) EXPECT_TRUE(is_closed(part));
  const double a = signed_volume(parts[0]), b = signed_volume(parts[1]);
  EXPECT_NEAR(std::min(a, b), inner, 1e-9 * both);
  EXPECT_NEAR(std::max(a, b), both, 1e-9 * both);
  const TetMesh open =
      numbered(block, [](const Vec3& p) { return p.z() > 0.02 && p.x() > 0.02 ? 1 : 0; });
  EXPECT_TRUE(BodyRegions(open).enclosed().empty());
}

// A mesh that reaches a little beyond the body has nothing else there.
TEST(BodyRegions, TheBodysSurfaceIsNoBoundary) {
  const TetMesh mesh = numbered(test::block_mesh(kSize, 6, 5, 3, 1),
                                [](const Vec3& p) { return p.z() > 0.02 ? 1 : 0; });
  TetMesh higher = test::block_mesh({kSize.x(), kSize.y(), 1.1 * kSize.z()}, 6, 5, 6, 1);
  const auto volume = volumes(BodyRegions(mesh), higher);
  EXPECT_NEAR(volume.at(1) / (kSize.x() * kSize.y()), 0.013, 1e-12);
}

}  // namespace
}  // namespace hapsim
