// Rows of presses beside a border between regions are no region; strips, rings and inclusions are
// told from them.
#include "regions/border_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace hapsim {
namespace {

struct Field {
  std::vector<Vec3> places;
  Eigen::VectorXd value;
  std::vector<int> label;
};

// 6 x 9 places 20 mm apart.
Field field(const std::function<std::pair<double, int>(int i, int j)>& of) {
  Field f;
  f.value.resize(54);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 6; ++i) {
      const auto [value, label] = of(i, j);
      f.value[static_cast<Eigen::Index>(f.places.size())] = value;
      f.places.emplace_back(0.02 * i, 0.02 * j, 0.06);
      f.label.push_back(label);
    }
  return f;
}

int regions(const Field& f) {
  return static_cast<int>(std::set<int>(f.label.begin(), f.label.end()).size());
}

TEST(BorderSamples, ARowBetweenTwoRegionsJoinsTheNearer) {
  for (const double at : {0.2, 0.8}) {
    Field f = field([&](int, int j) {
      return j < 4 ? std::pair(0.0, 0) : j == 4 ? std::pair(at, 2) : std::pair(1.0, 1);
    });
    EXPECT_EQ(dissolve_borders(f.places, f.value, f.label), 6);
    EXPECT_EQ(regions(f), 2);
    EXPECT_EQ(f.label[4 * 6], at < 0.5 ? 0 : 1);
  }
}

TEST(BorderSamples, ARingAboutAnInclusionIsItsBorder) {
  Field f = field([](int i, int j) {
    const int away = std::max(std::abs(i - 2), std::abs(j - 4));
    return away == 0 ? std::pair(1.0, 1) : away == 1 ? std::pair(0.3, 2) : std::pair(0.0, 0);
  });
  EXPECT_EQ(dissolve_borders(f.places, f.value, f.label), 8);
  EXPECT_EQ(regions(f), 2);
  EXPECT_EQ(std::count(f.label.begin(), f.label.end(), 1), 1);
}

TEST(BorderSamples, AStripOfTwoRowsIsARegion) {
  Field f = field([](int, int j) {
    return j < 3 ? std::pair(0.0, 0) : j < 5 ? std::pair(0.5, 2) : std::pair(1.0, 1);
  });
  EXPECT_EQ(dissolve_borders(f.places, f.value, f.label), 0);
  EXPECT_EQ(regions(f), 3);
}

TEST(BorderSamples, ASoftestOrStiffestRowIsARegion) {
  Field f = field([](int, int j) {
    return j < 4 ? std::pair(0.0, 0) : j == 4 ? std::pair(2.0, 2) : std::pair(1.0, 1);
  });
  EXPECT_EQ(dissolve_borders(f.places, f.value, f.label), 0);
  EXPECT_EQ(regions(f), 3);
}

}  // namespace
}  // namespace hapsim
