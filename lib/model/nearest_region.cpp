#include "model/nearest_region.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace hapsim {

LocalModulus local_modulus(const MaterialSpec& material, const Vec3& p) {
  constexpr std::size_t kNeighbours = 8;
  constexpr double kSame = 1e-4;             // [m]: contact points that close are one position
  constexpr double kReach = 1.5;             // of the farthest neighbour
  std::vector<std::pair<double, int>> near;  // distance, region
  for (std::size_t k = 0; k < material.key_point.size(); ++k)
    near.emplace_back((material.key_point[k] - p).head<2>().norm(), material.key_region[k]);
  if (near.empty()) return {material.modulus.front(), {{0, 1.0}}};
  const std::size_t count = std::min(kNeighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  near.resize(count);
  LocalModulus result;
  if (near.front().first < kSame) {
    result.share = {{near.front().second, 1.0}};
  } else {
    const double reach = kReach * near.back().first;
    std::map<int, double> share;
    double sum = 0;
    for (const auto& [distance, region] : near) {
      const double weight = std::pow((reach - distance) / (reach * distance), 2);
      share[region] += weight;
      sum += weight;
    }
    for (const auto& [region, weight] : share) result.share.emplace_back(region, weight / sum);
  }
  double log_modulus = 0;
  for (const auto& [region, share] : result.share)
    log_modulus += share * std::log(material.modulus[static_cast<std::size_t>(region)]);
  result.value = std::exp(log_modulus);
  return result;
}

}  // namespace hapsim
