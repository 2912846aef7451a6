#include "model/weights.h"

#include <Eigen/Dense>
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

}  // namespace

Eigen::MatrixXd gain_directions(const Dataset& dataset, const Selection& selection,
                                const Eigen::VectorXd& reference) {
  const std::map<int, Place> places = places_of(dataset, selection);
  Eigen::MatrixXd Z =
      Eigen::MatrixXd::Zero(reference.size(), 2 * static_cast<Eigen::Index>(places.size()));
  Eigen::Index column = 0;
  for (const auto& [position, place] : places) {
    for (const Eigen::Index row : place.starts) {
      const Vec3 f = reference.segment<3>(row);
      const Vec3 along = place.normal.dot(f) * place.normal;
      Z.block<3, 1>(row, column) = along;
      Z.block<3, 1>(row, column + 1) = f - along;
    }
    column += 2;
  }
  return Z;
}

Weights::Weights(const Dataset& dataset, const Selection& selection,
                 const Eigen::VectorXd& reference, double noise, double floor)
    : noise_(noise) {
  if (floor <= 0) return;
  const Eigen::MatrixXd all = gain_directions(dataset, selection, reference);
  Eigen::Index column = 0;
  for (const auto& [position, place] : places_of(dataset, selection)) {
    Block block;
    for (const Eigen::Index row : place.starts)
      for (int k = 0; k < 3; ++k) block.rows.push_back(row + k);
    const Eigen::MatrixXd Z = all.middleCols(column, 2)(block.rows, Eigen::all);
    column += 2;
    // Z Z' = Q diag(s^2) Q'; the two columns are orthogonal only sample by sample, hence the SVD.
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Z, Eigen::ComputeThinU);
    block.Q = svd.matrixU();
    const Eigen::VectorXd s = svd.singularValues();
    block.shrink = 1 - (1 + (floor / noise * s.array()).square()).sqrt().inverse();
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
