#include "diagnose/shared_law.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hapsim {
namespace {

constexpr double kBent = 0.25;  // of the largest force, where an axis' own curve has its bends
constexpr Eigen::Index kOfAxes = 30, kPieces = 3, kNumbers = kOfAxes + 2 * kPieces;

// v where it is longer than `from`, less that.
Vec3 beyond(const Vec3& v, double from) {
  const double size = v.norm();
  return size > from ? Vec3((1 - from / size) * v) : Vec3::Zero();
}

}  // namespace

Eigen::MatrixXd law_columns(const Eigen::VectorXd& forces, const Dataset& dataset) {
  std::vector<Vec3> along, across;
  double most_along = 0, most_across = 0;
  Eigen::Index at = 0;
  for (const int e : all_episodes(dataset)) {
    const Episode& episode = dataset.episodes[static_cast<std::size_t>(e)];
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      const Vec3 f = forces.segment<3>(at);
      along.emplace_back(f.dot(episode.view.normal) * episode.view.normal);
      across.emplace_back(f - along.back());
      most_along = std::max(most_along, along.back().norm());
      most_across = std::max(most_across, across.back().norm());
    }
  }
  const Vec3 most_by_axis =
      forces.reshaped(3, forces.size() / 3).rowwise().lpNorm<Eigen::Infinity>();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(forces.size(), kNumbers);
  for (at = 0; at < forces.size(); at += 3) {
    const auto sample = static_cast<std::size_t>(at / 3);
    Eigen::Index column = 0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double own = forces[at + axis], bent = kBent * most_by_axis[axis];
      for (const double law :
           {own, std::abs(own), std::max(0.0, own - bent), std::min(0.0, own + bent)})
        columns(at + axis, column++) = law;
      for (Eigen::Index by = 0; by < 3; ++by) {
        if (by == axis) continue;
        const double f = forces[at + by];
        for (const double law : {f, std::abs(f), f * std::abs(f)})
          columns(at + axis, column++) = law;
      }
    }
    for (Eigen::Index piece = 0; piece < kPieces; ++piece) {
      const double from = static_cast<double>(piece) / static_cast<double>(kPieces);
      columns.block<3, 1>(at, kOfAxes + 2 * piece) = beyond(along[sample], from * most_along);
      columns.block<3, 1>(at, kOfAxes + 2 * piece + 1) = beyond(across[sample], from * most_across);
    }
  }
  return columns;
}

}  // namespace hapsim
