// What a contact between the pressed positions feels when each stands for itself.
#include "experiment/nearest_region.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace hapsim {
namespace {

// A grid of key points 10 mm apart, each a region, and log E by place.
template <typename Field>
MaterialSpec sites(int count, const Field& log_modulus) {
  MaterialSpec material;
  material.local = true;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const Vec3 p(0.01 * i, 0.01 * j, 0);
      material.key_point.push_back(p);
      material.key_region.push_back(static_cast<int>(material.modulus.size()));
      material.modulus.push_back(std::exp(log_modulus(p)));
      material.modulus_column.push_back(-1);
    }
  return material;
}

TEST(LocalModulus, IsTheKeyPointsOwnThere) {
  Random random(3);
  const MaterialSpec m = sites(5, [&](const Vec3&) { return 9 + random.uniform(); });
  for (std::size_t k = 0; k < m.key_point.size(); ++k) {
    const Vec3 above = m.key_point[k] + Vec3(0, 0, 0.03);  // in plan view
    EXPECT_NEAR(local_modulus(m, above).value / m.modulus[k], 1, 1e-12);
  }
}

TEST(LocalModulus, FollowsAGradualChangeBetweenAndALittleBeyond) {
  const auto field = [](const Vec3& p) { return 9.6 + 20 * p.x() - 8 * p.y(); };
  const MaterialSpec m = sites(5, field);
  double most = 0;
  for (double x = -0.004; x <= 0.044; x += 0.0037)
    for (double y = -0.004; y <= 0.044; y += 0.0037) {
      const Vec3 p(x, y, 0);
      most = std::max(most, std::abs(std::log(local_modulus(m, p).value) - field(p)));
    }
  std::printf("largest error %.4f of a change of 0.2 from one point to the next\n", most);
  EXPECT_LT(most, 0.02);
}

// Shares are the derivatives of log E by those of the regions.
TEST(LocalModulus, SharesAreItsDerivatives) {
  Random random(4);
  MaterialSpec m = sites(4, [&](const Vec3&) { return 9 + random.uniform(); });
  const Vec3 p(0.0132, 0.0271, 0);
  const LocalModulus at = local_modulus(m, p);
  double sum = 0;
  for (const auto& [region, share] : at.share) {
    sum += share;
    MaterialSpec more = m;
    more.modulus[static_cast<std::size_t>(region)] *= std::exp(1e-6);
    EXPECT_NEAR(std::log(local_modulus(more, p).value / at.value) / 1e-6, share, 1e-6);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(LocalModulus, OneAndTwoKeyPointsSuffice) {
  MaterialSpec m = sites(1, [](const Vec3&) { return 9.0; });
  EXPECT_NEAR(local_modulus(m, {0.02, 0.01, 0}).value, std::exp(9.0), 1e-8);
  m.key_point.emplace_back(0.02, 0, 0);
  m.key_region.push_back(1);
  m.modulus.push_back(std::exp(10.0));
  const double between = std::log(local_modulus(m, {0.01, 0, 0}).value);
  EXPECT_NEAR(between, 9.5, 0.01);
}

}  // namespace
}  // namespace hapsim
