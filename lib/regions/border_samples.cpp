#include "regions/border_samples.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

bool are_neighbours(const std::vector<Vec3>& places, std::size_t i, std::size_t j) {
  const double square = (places[i] - places[j]).squaredNorm();
  for (std::size_t k = 0; k < places.size(); ++k)
    if (k != i && k != j &&
        (places[k] - places[i]).squaredNorm() + (places[k] - places[j]).squaredNorm() <
            square * (1 - 1e-9))
      return false;
  return true;
}

}  // namespace

int dissolve_borders(const std::vector<Vec3>& places, const Eigen::VectorXd& value,
                     std::vector<int>& label) {
  const int clusters = 1 + *std::max_element(label.begin(), label.end());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(clusters), size = mean;
  for (std::size_t i = 0; i < label.size(); ++i) {
    mean[label[i]] += value[static_cast<Eigen::Index>(i)];
    size[label[i]] += 1;
  }
  mean = mean.cwiseQuotient(size);
  const std::vector<int> before = label;
  int moved = 0;
  for (int c = 0; c < clusters; ++c) {
    std::vector<int> taken;  // by its samples, in order
    bool border = true;
    for (std::size_t i = 0; i < before.size() && border; ++i) {
      if (before[i] != c) continue;
      int softer = -1, stiffer = -1;  // of the neighbours, the farthest in value
      for (std::size_t j = 0; j < before.size(); ++j) {
        const int other = before[j];
        if (other == c || !are_neighbours(places, i, j)) continue;
        if (mean[other] < mean[c] && (softer < 0 || mean[other] < mean[softer])) softer = other;
        if (mean[other] > mean[c] && (stiffer < 0 || mean[other] > mean[stiffer])) stiffer = other;
      }
      border = softer >= 0 && stiffer >= 0;
      if (!border) break;
      const double x = value[static_cast<Eigen::Index>(i)];
      taken.push_back(x - mean[softer] < mean[stiffer] - x ? softer : stiffer);
    }
    if (!border) continue;
    auto next = taken.begin();
    for (std::size_t i = 0; i < before.size(); ++i)
      if (before[i] == c) label[i] = *next++;
    moved += static_cast<int>(taken.size());
  }
  return moved;
}

}  // namespace hapsim
