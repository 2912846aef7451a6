#include "diagnose/shared_law.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hapsim {
namespace {

constexpr double kBent = 0.25;  // of the largest force, where an axis' own curve has its bends
constexpr Eigen::Index kOfAxes = 24, kPieces = 3, kNumbers = kOfAxes + 2 * kPieces;

// What columns take of a residual: squares [N^2], by how many numbers.
struct Taken {
  double squares = 0;
  Eigen::Index numbers = 0;
  double beyond(double noise) const {
    return squares - static_cast<double>(numbers) * noise * noise;
  }
  Taken& operator+=(const Taken& other) {
    squares += other.squares;
    numbers += other.numbers;
    return *this;
  }
};

Taken taken(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd r = qr.householderQ().transpose() * residual;
  return {r.head(qr.rank()).squaredNorm(), qr.rank()};
}

Taken taken_by_places(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                      const Dataset& dataset) {
  Taken all;
  for (const GainBlock& place : gain_directions(dataset, all_episodes(dataset), forces))
    all += taken(place.Z, residual(place.rows));
  return all;
}

// v where it is longer than `from`, less that.
Vec3 beyond(const Vec3& v, double from) {
  const double size = v.norm();
  return size > from ? Vec3((1 - from / size) * v) : Vec3::Zero();
}

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
        columns(at + axis, column++) = f;
        columns(at + axis, column++) = f * std::abs(f);
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

Taken taken_by_presses(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                       const Dataset& dataset) {
  Taken all;
  Eigen::Index at = 0;
  for (const Episode& e : dataset.episodes) {
    const auto size = 3 * static_cast<Eigen::Index>(e.rows.size());
    all += taken(forces.segment(at, size), residual.segment(at, size));
    at += size;
  }
  return all;
}

}  // namespace

Account account_of(const Eigen::VectorXd& residual, const Eigen::VectorXd& forces,
                   const TrialGround& g) {
  constexpr double kMost = 0.9, kAsMuch = 0.96, kPlainlyMore = 1.2;
  const double noise = g.allowance.noise;
  const double most = kMost * Taken{residual.squaredNorm(), residual.size()}.beyond(noise);
  const Taken places = taken_by_places(residual, forces, g.dataset);
  const double presses = taken_by_presses(residual, forces, g.dataset).beyond(noise);
  if (presses > most && presses > kPlainlyMore * places.beyond(noise)) return Account::kPresses;
  const Taken law = taken(law_columns(forces, g.dataset), residual);
  if (law.numbers < places.numbers && law.beyond(noise) > most &&
      law.beyond(noise) > kAsMuch * places.beyond(noise))
    return Account::kOneLaw;
  return Account::kPlaces;
}

}  // namespace hapsim
