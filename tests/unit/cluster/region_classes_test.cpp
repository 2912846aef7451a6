// From location samples to regions and their boundary, thesis 5.2 with its errata.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/random.h"
#include "cluster/class_boundary.h"
#include "cluster/division.h"
#include "cluster/qda.h"

namespace hapsim {
namespace {

using Map = PlaneClassifier;  // the true region of a plan position

// The cuboid of thesis 6.4, 120 x 210 mm, pressed at 4 x 5 positions.
constexpr double kWidth = 0.12, kLength = 0.21;
const Eigen::Vector2d kLow(0, 0), kHigh(kWidth, kLength);

Eigen::Vector2d position(int i) {
  return {kWidth * (i % 4 + 0.5) / 4, kLength * (i / 4 + 0.5) / 5};
}

// A boundary at a random place, slope and bulge, across or along the cuboid. A tool (radius 5 mm)
// that sits on the boundary belongs to neither side, and a region of less than four positions has
// no measurable shape: such draws are left out.
Map random_boundary(Random& random) {
  for (;;) {
    const double at = 0.04 + 0.12 * random.uniform(), bulge = 0.06 * (random.uniform() - 0.5);
    const double slope = 0.4 * (random.uniform() - 0.5);
    const bool across = random.coin();
    const Map map = [=](const Eigen::Vector2d& p) {
      const double u = across ? p.x() : p.y() * kWidth / kLength;
      const double v = across ? p.y() : p.x() * kLength / kWidth;
      return v > at + slope * u + bulge * std::sin(std::numbers::pi * u / kWidth) ? 1 : 0;
    };
    const auto lines = class_boundaries(map, kLow, kHigh, 20000);
    int upper = 0;
    double nearest = 1;
    for (int i = 0; i < 20; ++i) {
      upper += map(position(i));
      nearest = std::min(nearest, distance_to(lines, position(i)));
    }
    if (lines.size() == 1 && nearest > 0.006 && upper >= 4 && upper <= 16) return map;
  }
}
int bands(const Eigen::Vector2d& p) {
  return p.y() < 0.085 + 0.1 * (p.x() - 0.06) ? 0 : p.y() < 0.125 ? 1 : 2;
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
Sampled sample(const Map& map, double factor, std::uint64_t seed) {
  Random random(seed);
  Sampled s{Eigen::MatrixXd(20, 2), Eigen::MatrixXd(20, 2), Eigen::MatrixXd(20, 2), {}};
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d p = position(i);
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
  int regions = 0, wrong = 0;  // pairs of positions that are together or apart and should not
  int wrong_of_true = 0;       // the same when the number of regions is given
  double cophenetic = 0, boundary = 0;  // boundary: mean distance both ways [m]
};

Found find_regions(const Sampled& s, const Map& map, std::uint64_t seed) {
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
  const std::vector<int> given = cut(tree, 1 + *std::max_element(s.truth.begin(), s.truth.end()));
  for (std::size_t i = 0; i < label.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      found.wrong_of_true += (given[i] == given[j]) != (s.truth[i] == s.truth[j]);
  if (found.regions < 2) return found;
  const Qda qda = choose_qda(s.position, label, found.regions);
  const auto lines = class_boundaries([&](const Eigen::Vector2d& p) { return qda.classify(p); },
                                      kLow, kHigh, 20000);
  const auto truth = class_boundaries(map, kLow, kHigh, 20000);
  double sum = 0, count = 0;
  for (const auto& [from, to] : {std::pair{&lines, &truth}, std::pair{&truth, &lines}})
    for (const BoundaryLine& line : *from)
      for (const auto& p : key_points(line, 50)) sum += distance_to(*to, p), ++count;
  found.boundary = sum / count;
  return found;
}

TEST(RegionsFromLocations, TwoWithCurvedBoundaries) {
  int right = 0;
  double sum = 0, worst = 0, lowest = 1;
  Random shapes(1);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Map map = random_boundary(shapes);
    const Found f = find_regions(sample(map, 2.5, seed), map, seed);
    EXPECT_EQ(f.wrong_of_true, 0);
    right += f.regions == 2 && f.wrong == 0;
    sum += f.boundary;
    worst = std::max(worst, f.boundary);
    lowest = std::min(lowest, f.cophenetic);
  }
  std::printf(
      "two regions: %d of 20 right, cophenetic correlation from %.3f, boundary %.1f mm off "
      "on average, %.1f mm at most\n",
      right, lowest, 1e3 * sum / 20, 1e3 * worst);
  EXPECT_GE(right, 18);  // each region is divided once more with a chance of 5 % in all
  EXPECT_GT(lowest, 0.9);
  EXPECT_LT(sum / 20, 0.006);
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
