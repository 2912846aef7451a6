#include "experiment/weights.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hapsim {

namespace {

// Stacked rows (x components) of each position, and its normal.
struct Place {
  std::vector<Eigen::Index> starts;
  Vec3 normal = Vec3::UnitZ();
};

std::map<int, Place> places_of(const Dataset& dataset, const Selection& selection) {
  std::map<int, Place> places;
  Eigen::Index at = 0;
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[e];
    Place& place = places[episode.position];
    place.normal = episode.view.normal;
    for (std::size_t i = 0; i < episode.rows.size(); ++i, ++at) place.starts.push_back(3 * at);
  }
  return places;
}

// A basis of the symmetric matrices, in the frame of a normal.
std::array<Eigen::Matrix3d, 6> symmetric_basis(const Vec3& n) {
  const Vec3 s = n.unitOrthogonal(), t = n.cross(s);
  const auto pair = [](const Vec3& a, const Vec3& b) -> Eigen::Matrix3d {
    return std::sqrt(0.5) * (a * b.transpose() + b * a.transpose());
  };
  return {n * n.transpose(), s * s.transpose(), t * t.transpose(),
          pair(s, t),        pair(n, s),        pair(n, t)};
}

// Forces that are off by `share` of the largest there, and by less as the contact is smaller.
Eigen::VectorXd bend(Eigen::VectorXd force, double share) {
  double most = 0;
  for (Eigen::Index i = 0; i < force.size(); i += 3)
    most = std::max(most, force.segment<3>(i).norm());
  for (Eigen::Index i = 0; i < force.size(); i += 3)
    force.segment<3>(i) *= most > 0 ? share * std::cbrt(force.segment<3>(i).norm() / most) : 0;
  return force;
}

}  // namespace

Eigen::MatrixXd GainBlock::deviations(double floor) const {
  Eigen::MatrixXd D(Z.rows(), Z.cols() + (curve.size() > 0 ? 1 : 0));
  D.leftCols(Z.cols()) = floor * Z;
  if (curve.size() > 0) D.rightCols<1>() = curve;
  return D;
}

std::vector<GainBlock> gain_directions(const Dataset& dataset, const Selection& selection,
                                       const Eigen::VectorXd& reference) {
  std::vector<GainBlock> blocks;
  for (const auto& [position, place] : places_of(dataset, selection)) {
    const auto basis = symmetric_basis(place.normal);
    GainBlock block;
    block.position = position;
    block.Z.resize(3 * static_cast<Eigen::Index>(place.starts.size()), 6);
    Eigen::Index at = 0;
    for (const Eigen::Index row : place.starts) {
      for (int k = 0; k < 3; ++k) block.rows.push_back(row + k);
      for (Eigen::Index c = 0; c < 6; ++c)
        block.Z.block<3, 1>(at, c) = basis[static_cast<std::size_t>(c)] * reference.segment<3>(row);
      at += 3;
    }
    if (!dataset.curve_doubt.empty())
      block.curve =
          bend(reference(block.rows), dataset.curve_doubt[static_cast<std::size_t>(position)]);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

Weights::Weights(const Dataset& dataset, const Selection& selection,
                 const Eigen::VectorXd& reference, double noise, double floor)
    : noise_(noise) {
  if (floor <= 0) return;
  for (GainBlock& gains : gain_directions(dataset, selection, reference)) {
    // D D' = Q diag(s^2) Q'.
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
        gains.deviations(dataset.floor_at(static_cast<std::size_t>(gains.position), floor)),
        Eigen::ComputeThinU);
    Block block;
    block.rows = std::move(gains.rows);
    block.Q = svd.matrixU();
    const Eigen::VectorXd s = svd.singularValues();
    block.shrink = 1 - (1 + (s.array() / noise).square()).sqrt().inverse();
    blocks_.push_back(std::move(block));
  }
}

void Weights::whiten(Eigen::Ref<Eigen::MatrixXd> columns) const {
  columns /= noise_;
  for (const Block& block : blocks_) {
    const Eigen::MatrixXd part = columns(block.rows, Eigen::all);
    columns(block.rows, Eigen::all) =
        part - block.Q * (block.shrink.asDiagonal() * (block.Q.transpose() * part));
  }
}

}  // namespace hapsim
