#include "acfm/acfm.h"

#include <Eigen/Geometry>
#include <cassert>
#include <cmath>

namespace hapsim {

Eigen::Matrix3d acfm_frame(const Vec3& normal) {
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
}

Stiffening stiffening_at(double s, double r) {
  const double x = s * r;
  if (std::abs(x) < 1e-4) return {1 + x / 2 + x * x / 6, r * (0.5 + x / 3 + x * x / 8)};
  const double factor = std::expm1(x) / x;
  return {factor, r * (std::exp(x) - factor) / x};
}

SubModel Acfm::at(const Vec3& point) const noexcept {
  assert(!positions.empty());
  // The nearest ones and the next, by insertion.
  std::array<double, kNeighbours + 1> distance{};
  std::array<std::size_t, kNeighbours + 1> index{};
  std::size_t found = 0;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const double d = (positions[p].point - point).norm();
    std::size_t k = std::min(found, distance.size() - 1);
    if (found == distance.size() && d >= distance[k]) continue;
    for (; k > 0 && distance[k - 1] > d; --k) {
      distance[k] = distance[k - 1];
      index[k] = index[k - 1];
    }
    distance[k] = d;
    index[k] = p;
    found = std::min(found + 1, distance.size());
  }
  const double same = 1e-9;  // [m]
  if (distance[0] < same || found == 1) {
    SubModel model = positions[index[0]];
    model.point = point;
    return model;
  }
  const bool next = found > static_cast<std::size_t>(kNeighbours);
  const std::size_t count = next ? static_cast<std::size_t>(kNeighbours) : found;
  const double reach = next ? distance[count] : 0;
  std::array<double, kNeighbours> weight{};
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double w = 1 / distance[k] - (next ? 1 / reach : 0);
    weight[k] = w * w;
    sum += weight[k];
  }
  if (!(sum > 0)) {  // all equally far
    weight.fill(1);
    sum = static_cast<double>(count);
  }
  SubModel model;
  model.point = point;
  model.normal.setZero();
  for (std::size_t k = 0; k < count; ++k) {
    const SubModel& from = positions[index[k]];
    const double share = weight[k] / sum;
    model.normal += share * from.normal;
    for (std::size_t a = 0; a < 3; ++a) {
      AcfmAxis& axis = model.axis[a];
      for (const std::size_t slot : {std::size_t{0}, AcfmAxis::kStiffening})
        axis.value[slot] += share * from.axis[a].value[slot];
      for (int i = 0; i < terms; ++i) {
        const auto at = static_cast<std::size_t>(2 * i + 1);
        axis.value[at] += share * from.axis[a].value[at];
        axis.value[at + 1] += share * std::log(from.axis[a].value[at + 1]);
      }
    }
  }
  for (AcfmAxis& axis : model.axis)
    for (int i = 0; i < terms; ++i) {
      double& tau = axis.value[static_cast<std::size_t>(2 * i + 2)];
      tau = std::exp(tau);
    }
  const double length = model.normal.norm();
  model.normal = length > 0 ? Vec3(model.normal / length) : positions[index[0]].normal;
  return model;
}

}  // namespace hapsim
