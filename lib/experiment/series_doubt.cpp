#include "experiment/series_doubt.h"

#include <algorithm>
#include <cmath>

#include "effects/local_contact.h"

namespace hapsim {
namespace {

constexpr double kShare = 0.1, kMost = 0.5;

double share_of(const Eigen::Matrix3d& K, const Vec3& normal, const DiscStiffness& disc) {
  return std::min(kShare * std::abs(normal.dot(K * normal) / disc.normal - 1), kMost);
}

bool is_ball(const Dataset& dataset) {
  return dataset.tools() == 1 && dataset.recording.has_ball();
}

}  // namespace

std::vector<double> series_doubt(const Places& places, const Dataset& dataset, double nu) {
  std::vector<double> doubt;
  if (!is_ball(dataset)) return doubt;
  const DiscStiffness disc = bonded_disc(1, nu, dataset.setups.front().tool_radius);
  for (std::size_t p = 0; p < places.size(); ++p) {
    Eigen::Matrix3d K, dK_dnu;
    places.contact(p).stiffness.evaluate(nu, K, dK_dnu);
    doubt.push_back(share_of(K, places.contact(p).normal, disc));
  }
  return doubt;
}

}  // namespace hapsim
