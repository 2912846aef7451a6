#include "reconstruct/clean_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "reconstruct/normals.h"

namespace hapsim {
namespace {

// The upper half of a ball of radius 50 mm, uniform, with Gaussian noise.
std::vector<Vec3> hemisphere(int n, double noise, Random& random) {
  std::vector<Vec3> points;
  while (static_cast<int>(points.size()) < n) {
    Vec3 v(random.normal(), random.normal(), random.normal());
    v.normalize();
    if (v.z() < 0) continue;
    points.push_back(0.05 * v + noise * Vec3(random.normal(), random.normal(), random.normal()));
  }
  return points;
}

TEST(CleanPoints, RemovesGrossOutliersAndKeepsTheRest) {
  Random random(5);
  PointCloud cloud{hemisphere(2000, 2e-4, random), {}};
  for (int i = 0; i < 20; ++i) {
    cloud.points.push_back((0.065 + 0.03 * random.uniform()) *
                           Vec3(random.normal(), random.normal(), random.normal()).normalized());
  }
  CleanReport report;
  const PointCloud clean = clean_points(cloud, {}, "scan", report);
  int far = 0, near = 0;
  for (const Vec3& p : clean.points) (std::abs(p.norm() - 0.05) > 5e-3 ? far : near)++;
  EXPECT_EQ(far, 0);
  EXPECT_GE(near, 1990);
  EXPECT_EQ(report.kept + report.isolated + report.off_surface, report.read);
}

TEST(CleanPoints, AnUnevenDensityCostsNothing) {
  Random random(6);
  PointCloud cloud;
  for (const Vec3& p : hemisphere(6000, 1e-4, random)) {
    if (p.x() < 0 || random.uniform() < 0.08) cloud.points.push_back(p);
  }
  CleanReport report;
  clean_points(cloud, {}, "scan", report);
  EXPECT_LE(report.isolated + report.off_surface, cloud.points.size() / 200);
}

TEST(CleanPoints, CountsDoublesAndThins) {
  Random random(7);
  PointCloud cloud{hemisphere(1000, 0, random), {}};
  for (int i = 0; i < 100; ++i) {
    cloud.points.push_back(cloud.points[i]);
    cloud.points.push_back(cloud.points[i] + Vec3(1e-9, 0, 0));
  }
  CleanReport report;
  clean_points(cloud, {}, "scan", report);
  EXPECT_EQ(report.duplicates, 100u);
  EXPECT_EQ(report.near_duplicates, 100u);
  EXPECT_EQ(report.thinned(), 0u);
  CleanOptions options;
  options.spacing = 0.01;
  const PointCloud thin = clean_points(cloud, options, "scan", report);
  EXPECT_EQ(report.duplicates, 100u);
  EXPECT_EQ(report.kept, thin.points.size());
  // 2 pi 0.05^2 / 0.01^2 = 157 cells a flat sheet of them would need.
  EXPECT_GT(thin.points.size(), 120u);
  EXPECT_LT(thin.points.size(), 350u);
}

TEST(CleanPoints, RefusesWhatIsNoSurface) {
  PointCloud line;
  for (int i = 0; i < 50; ++i) line.points.emplace_back(0.001 * i, 0.002 * i, 0);
  const PointCloud same{std::vector<Vec3>(100, Vec3(1, 2, 3)), {}};
  const PointCloud two{{{0, 0, 0}, {1, 0, 0}}, {}};
  for (const PointCloud& cloud : {line, same, two}) {
    CleanReport report;
    try {
      clean_points(cloud, {}, "scan", report);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
    }
  }
}

TEST(Normals, PointOutwardOnNoisyAndTouchedScans) {
  Random random(8);
  // Second: five times as many points, their noise larger than their distance.
  for (const auto& [n, noise] : {std::pair(2000, 2e-4), std::pair(12000, 6e-4)}) {
    PointCloud cloud{hemisphere(n, noise, random), {}};
    NormalsReport report;
    estimate_normals(cloud, Vec3::UnitZ(), report);
    int right = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      right += cloud.normals[i].dot(cloud.points[i].normalized()) > 0.9 ? 1 : 0;
    }
    EXPECT_GT(right, 0.97 * n);
  }
}

TEST(Normals, OfAFlatPatchPointUp) {
  Random random(9);
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    const double x = 0.1 * random.uniform(), y = 0.1 * random.uniform();
    // A bowl: away from the centre would be down.
    cloud.points.emplace_back(x, y, 2 * (std::pow(x - 0.05, 2) + std::pow(y - 0.05, 2)));
  }
  NormalsReport report;
  estimate_normals(cloud, Vec3::UnitZ(), report);
  for (const Vec3& n : cloud.normals) EXPECT_GT(n.z(), 0.5);
}

}  // namespace
}  // namespace hapsim
