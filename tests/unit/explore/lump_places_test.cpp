// Presses about a lump: near it, on all sides, and none that says the same again.
#include "explore/lump_places.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hapsim {
namespace {

std::vector<PressablePlace> plane() {
  std::vector<PressablePlace> places;
  for (int i = 0; i < 21; ++i)
    for (int j = 0; j < 21; ++j) places.push_back({Vec3(0.004 * i, 0.004 * j, 0), Vec3::UnitZ()});
  return places;
}

// What small lumps do: g(c) of lump_places.h.
std::vector<SeenPlace> seen_of(const Vec3& lump, const std::vector<Vec3>& points) {
  std::vector<SeenPlace> seen;
  for (const Vec3& p : points) {
    const double z = p.z() - lump.z(), d = (lump - p).squaredNorm() + 16e-6;
    seen.push_back({p, 4e-7 * z * z / (d * d * d)});
  }
  return seen;
}

TEST(LumpPlaces, LieAboutTheLump) {
  Lump lump;
  lump.centre = Vec3(0.052, 0.040, -0.009);
  const std::vector<SeenPlace> seen = seen_of(lump.centre, {{0.016, 0.016, 0},
                                                            {0.064, 0.016, 0},
                                                            {0.016, 0.064, 0},
                                                            {0.064, 0.064, 0},
                                                            {0.040, 0.040, 0},
                                                            {0.052, 0.030, 0}});
  const std::vector<PressablePlace> next = lump_places(plane(), seen, lump, 0.004, 0.01, 6);
  ASSERT_EQ(next.size(), 6u);
  double left = 0, right = 0, above = 0, below = 0;
  for (std::size_t k = 0; k < next.size(); ++k) {
    const Vec3 d = next[k].point - Vec3(lump.centre.x(), lump.centre.y(), 0);
    // No farther than twice its depth: beyond, it moves no gain.
    EXPECT_LT(d.norm(), 0.018) << next[k].point.transpose();
    left = std::min(left, d.x()), right = std::max(right, d.x());
    below = std::min(below, d.y()), above = std::max(above, d.y());
    for (const SeenPlace& s : seen) EXPECT_GE((s.point - next[k].point).norm(), 0.002);
    for (std::size_t m = 0; m < k; ++m) EXPECT_GE((next[m].point - next[k].point).norm(), 0.002);
  }
  EXPECT_LT(left, -0.001);
  EXPECT_GT(right, 0.001);
  EXPECT_LT(below, -0.001);
  EXPECT_GT(above, 0.001);
}

TEST(LumpPlaces, NoPlaceNoPress) {
  EXPECT_TRUE(lump_places({}, {}, Lump{}, 0.004, 0.01, 3).empty());
}

}  // namespace
}  // namespace hapsim
