#include "reconstruct/merge_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "reconstruct/clean_points.h"

namespace hapsim {
namespace {

constexpr double kRadius = 0.05;

std::vector<Vec3> ball(int n, double noise, Random& random) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i)
    points.push_back(kRadius *
                         Vec3(random.normal(), random.normal(), random.normal()).normalized() +
                     noise * Vec3(random.normal(), random.normal(), random.normal()));
  return points;
}

struct Off {
  double mean = 0, rms = 0;  // of the distances from the ball's surface [m]
};

Off off_ball(const std::vector<Vec3>& points) {
  Off off;
  for (const Vec3& p : points) {
    off.mean += (p.norm() - kRadius) / static_cast<double>(points.size());
    off.rms += std::pow(p.norm() - kRadius, 2) / static_cast<double>(points.size());
  }
  off.rms = std::sqrt(off.rms);
  return off;
}

TEST(MergePoints, NoiseFallsByTheRootOfThePointsAndTheMeanStaysOnTheSurface) {
  Random random(3);
  const double noise = 2e-4;
  const PointCloud cloud{ball(100000, noise, random), {}};
  MergeReport report;
  const MergedPoints merged = merge_points(cloud, 0, report);
  EXPECT_EQ(report.before, cloud.points.size());
  EXPECT_EQ(report.after, merged.cloud.points.size());
  EXPECT_NEAR(report.noise, noise, 0.2 * noise);
  EXPECT_GE(report.spacing, kMergeNoises * report.noise);
  const double each = static_cast<double>(report.before) / static_cast<double>(report.after);
  EXPECT_GT(each, 3);
  const Off off = off_ball(merged.cloud.points);
  // No worse than one and a half times what the mean of as many points has.
  EXPECT_LT(off.rms, 1.5 * noise / std::sqrt(each));
  // Within four standard errors of the sagitta of parts of this width.
  const double sagitta = report.spacing * report.spacing / (12 * kRadius);
  EXPECT_NEAR(off.mean, 0, sagitta + 4 * noise / std::sqrt(100000.0));
}

TEST(MergePoints, IndicesAndCountsAreOfThePointsGiven) {
  Random random(4);
  const PointCloud cloud{ball(20000, 0, random), {}};
  MergeReport report;
  const MergedPoints merged = merge_points(cloud, 0.004, report);
  EXPECT_TRUE(report.asked);
  // A ball of this radius has 1963 squares of 4 mm.
  EXPECT_NEAR(static_cast<double>(report.after), 1963, 500);
  int sum = 0;
  for (std::size_t i = 0; i < merged.index.size(); ++i) {
    sum += merged.count[i];
    EXPECT_LT((cloud.points[merged.index[i]] - merged.cloud.points[i]).norm(), 0.004);
    if (i > 0) {
      EXPECT_GT(merged.index[i], merged.index[i - 1]);
    }
  }
  EXPECT_EQ(sum, 20000);
}

TEST(MergePoints, SparsePointsStayAsTheyAre) {
  Random random(5);
  const PointCloud cloud{ball(10000, 1e-4, random), {}};
  MergeReport report;
  const MergedPoints merged = merge_points(cloud, 0, report);
  EXPECT_EQ(report.after, report.before);
  EXPECT_EQ(merged.cloud.points, cloud.points);
}

// A wall of half the spacing, and an edge: normals keep their sides apart.
TEST(MergePoints, SidesOfAThinWallAreNotMixed) {
  Random random(6);
  PointCloud cloud;
  for (int i = 0; i < 20000; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    cloud.points.emplace_back(0.05 * random.uniform(), 0.05 * random.uniform(), side * 5e-4);
    cloud.normals.emplace_back(0, 0, side);
  }
  MergeReport report;
  const MergedPoints merged = merge_points(cloud, 0.002, report);
  for (std::size_t i = 0; i < merged.cloud.points.size(); ++i)
    EXPECT_NEAR(merged.cloud.points[i].z(), 5e-4 * merged.cloud.normals[i].z(), 1e-12);
}

// Outliers of a dense scan are each other's neighbours, and as many to the volume as merged points.
TEST(MergePoints, OutliersOfADenseScanAreRemoved) {
  Random random(7);
  PointCloud cloud{ball(400000, 2e-4, random), {}};
  for (int i = 0; i < 2000; ++i)
    cloud.points.push_back(
        0.1 * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5));
  CleanReport report;
  const PointCloud clean = clean_points(cloud, {}, "scan", report);
  const auto far = std::count_if(clean.points.begin(), clean.points.end(),
                                 [](const Vec3& p) { return std::abs(p.norm() - kRadius) > 2e-3; });
  EXPECT_LE(far, 2);
  EXPECT_LT(off_ball(clean.points).rms, 1e-4);
}

}  // namespace
}  // namespace hapsim
