#include "experiment/nearest_region.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

namespace hapsim {
namespace {

constexpr std::size_t kNeighbours = 8;  // a ring about the point; a plane needs three
constexpr double kSame = 1e-4;          // [m]: contact points that close are one position
constexpr double kReach = 1.5;          // of the farthest neighbour
constexpr double kLevel = 0.05;  // pull of the slope towards none, of what the neighbours say of it

struct Neighbour {
  double distance;
  int region;
  Eigen::Vector2d way;  // from the point
};

// Each neighbour's share of the value of a plane through them at the point.
Eigen::VectorXd plane_shares(const std::vector<Neighbour>& near) {
  const double reach = kReach * near.back().distance;
  const auto n = static_cast<Eigen::Index>(near.size());
  Eigen::MatrixXd X(n, 3), weighted(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Neighbour& one = near[static_cast<std::size_t>(k)];
    const double weight = std::pow((reach - one.distance) / (reach * one.distance), 2);
    X.row(k) << 1, one.way.transpose();
    weighted.row(k) = weight * X.row(k);
  }
  Eigen::Matrix3d A = X.transpose() * weighted;
  const double pull = kLevel * (A(1, 1) + A(2, 2)) / 2;
  A(1, 1) += pull;
  A(2, 2) += pull;
  return weighted * A.ldlt().solve(Eigen::Vector3d::UnitX());
}

}  // namespace

LocalModulus local_modulus(const MaterialSpec& material, const Vec3& p) {
  std::vector<Neighbour> near;
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    const Eigen::Vector2d way = (material.key_point[k] - p).head<2>();
    near.push_back({way.norm(), material.key_region[k], way});
  }
  if (near.empty()) return {material.modulus.front(), {{0, 1.0}}};
  const std::size_t count = std::min(kNeighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                    [](const Neighbour& a, const Neighbour& b) { return a.distance < b.distance; });
  near.resize(count);
  LocalModulus result;
  if (near.front().distance < kSame || count == 1) {
    result.share = {{near.front().region, 1.0}};
  } else {
    const Eigen::VectorXd shares = plane_shares(near);
    std::map<int, double> share;
    for (std::size_t k = 0; k < count; ++k)
      share[near[k].region] += shares[static_cast<Eigen::Index>(k)];
    for (const auto& [region, s] : share) result.share.emplace_back(region, s);
  }
  double log_modulus = 0;
  for (const auto& [region, share] : result.share)
    log_modulus += share * std::log(material.modulus[static_cast<std::size_t>(region)]);
  result.value = std::exp(log_modulus);
  return result;
}

}  // namespace hapsim
