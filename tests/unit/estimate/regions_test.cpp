// From location samples to regions and their boundary, thesis 5.2 with its errata.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/random.h"
#include "estimate/class_boundary.h"
#include "estimate/division.h"
#include "estimate/qda.h"

namespace hapsim {
namespace {

using Map = int (*)(const Eigen::Vector2d&);  // the true region of a plan position

// The cuboid of thesis 6.4, 120 x 210 mm, pressed at 4 x 5 positions.
constexpr double kWidth = 0.12, kLength = 0.21;

int curved(const Eigen::Vector2d& p) {
  return p.y() > 0.095 + 0.03 * std::sin(std::numbers::pi * p.x() / kWidth) ? 1 : 0;
}
int bands(const Eigen::Vector2d& p) {
  return p.y() < 0.07 + 0.1 * (p.x() - 0.06) ? 0 : p.y() < 0.14 ? 1 : 2;
}
int whole(const Eigen::Vector2d&) {
  return 0;
}

struct Sampled {
  Eigen::MatrixXd position, value, error;
  std::vector<int> truth;
};

// A press feels the material about it: log E averaged over a Gaussian of 5 mm, then 3 % scatter of
// shape and contact of which the standard errors (1.5 %) know half; nu scatters by 0.02.
Sampled sample(Map map, double factor, std::uint64_t seed) {
  Random random(seed);
  Sampled s{Eigen::MatrixXd(20, 2), Eigen::MatrixXd(20, 2), Eigen::MatrixXd(20, 2), {}};
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d p(kWidth * (i % 4 + 0.5) / 4, kLength * (i / 4 + 0.5) / 5);
    double felt = 0;
    for (int k = 0; k < 400; ++k)
      felt += map(p + 0.005 * Eigen::Vector2d(random.normal(), random.normal())) / 400.0;
    s.position.row(i) = p.transpose();
    s.value.row(i) << std::log(10e3) + felt * std::log(factor) + 0.03 * random.normal(),
        0.4 + 0.02 * random.normal();
    s.error.row(i) << 0.015, 0.01;
    s.truth.push_back(map(p));
  }
  return s;
}

struct Found {
  int regions = 0, wrong = 0;
  double cophenetic = 0, boundary = 0;  // boundary: mean distance both ways [m]
};

Found find_regions(const Sampled& s, Map map, std::uint64_t seed) {
  Found found;
  const Eigen::MatrixXd d = scaled_distances(s.value, s.error);
  const Dendrogram tree = agglomerate(d, Linkage::kAverage);
  found.cophenetic = cophenetic_correlation(d, tree);
  Random random(seed);
  const std::vector<int> label =
      natural_division(s.value, s.error, Linkage::kAverage, random).label;
  found.regions = 1 + *std::max_element(label.begin(), label.end());
  for (std::size_t i = 0; i < label.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      found.wrong += (label[i] == label[j]) != (s.truth[i] == s.truth[j]);
  if (found.regions < 2) return found;
  const Qda qda = choose_qda(s.position, label, found.regions);
  const Eigen::Vector2d low(0, 0), high(kWidth, kLength);
  const auto lines =
      class_boundaries([&](const Eigen::Vector2d& p) { return qda.classify(p); }, low, high, 20000);
  const auto truth = class_boundaries(map, low, high, 20000);
  double sum = 0, count = 0;
  for (const auto& [from, to] : {std::pair{&lines, &truth}, std::pair{&truth, &lines}})
    for (const BoundaryLine& line : *from)
      for (const auto& p : key_points(line, 50)) sum += distance_to(*to, p), ++count;
  found.boundary = sum / count;
  return found;
}

TEST(RegionsFromLocations, TwoWithACurvedBoundary) {
  int right = 0;
  double worst = 0, lowest = 1;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Found f = find_regions(sample(curved, 2.5, seed), curved, seed);
    right += f.regions == 2 && f.wrong == 0;
    worst = std::max(worst, f.boundary);
    lowest = std::min(lowest, f.cophenetic);
  }
  std::printf("two regions: %d of 20 right, cophenetic correlation from %.3f, boundary %.1f mm\n",
              right, lowest, 1e3 * worst);
  EXPECT_EQ(right, 20);
  EXPECT_GT(lowest, 0.9);
  EXPECT_LT(worst, 0.006);
}

TEST(RegionsFromLocations, Three) {
  int right = 0;
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Found f = find_regions(sample(bands, 2, seed), bands, seed);
    right += f.regions == 3 && f.wrong == 0;
    worst = std::max(worst, f.boundary);
  }
  std::printf("three regions: %d of 20 right, boundary %.1f mm\n", right, 1e3 * worst);
  EXPECT_GE(right, 18);
}

TEST(RegionsFromLocations, One) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed)
    right += find_regions(sample(whole, 2, seed), whole, seed).regions == 1;
  std::printf("one region: %d of 60 right\n", right);
  EXPECT_GE(right, 53);  // the level is 5 %; fewer has a chance of 1 %
}

}  // namespace
}  // namespace hapsim
