#include "fit/marker_rows.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "fit/press_offsets.h"

namespace hapsim {
namespace {

constexpr double kMoved = 1e-9;  // of the largest sum of squares: a direction that was moved
constexpr double kOnceInThousand = 3.09;  // standard errors

// Of the forces that a model leaves, over what noise and the errors of the places let it leave.
double force_misfit(const Model& model, const Experiment& w, const Selection& selection,
                    double floor) {
  const Eigen::VectorXd f = solved_forces(model, w, selection, false).f;
  Eigen::MatrixXd residual = measured_forces(w.dataset, selection) - f;
  if (offset_effect(model) != nullptr) take_out_press_means(w.dataset, selection, residual);
  if (floor > 0)
    Weights(w.dataset, selection, f, w.noise.value, floor).whiten(residual);
  else
    residual /= w.noise.value;
  const double axes = w.dataset.axes() / 3.0;  // the others are zero
  return std::sqrt(residual.squaredNorm() / (axes * static_cast<double>(residual.size())));
}

}  // namespace

MarkerRows::MarkerRows(const Model& start, const Experiment& experiment, const Selection& selection,
                       const FitOptions& options)
    : experiment_(&experiment), markers_(options.markers), exact_regions_(options.exact_regions) {
  if (markers_ == nullptr) return;
  const Dataset& dataset = experiment.dataset;
  if (const std::string why = marker_refusal(start, dataset); !why.empty()) {
    unused_ = "marked points do not count: " + why;
    return;
  }
  std::map<std::pair<std::size_t, std::size_t>, MarkerSums> sums;  // position, point
  for (const int e : selection) {
    const auto i = static_cast<std::size_t>(e);
    for (std::size_t m = 0; m < markers_->points.size(); ++m)
      if (const MarkerSums& s = markers_->sums[i][m]; s.rows > 0)
        sums[{static_cast<std::size_t>(dataset.episodes[i].position), m}] += s;
  }
  if (sums.empty()) return;
  const MaterialSpec material = material_of(start);
  gains_ = MarkerGains(experiment.places, material, markers_->points, exact_regions_);
  noise_ = markers_->noise.value *
           std::max(1.0, force_misfit(start, experiment, selection, options.floor));
  std::vector<MarkerGain> here;
  std::size_t position = 0;
  for (const auto& [where, s] : sums) {
    if (here.empty() || where.first != position) here = gains_.at(position = where.first, material);
    const MarkerGain& now = here[where.second];
    Block block;
    block.position = position;
    block.point = where.second;
    block.sums = s;
    const double floor = dataset.floor_at(position, options.floor);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(s.uu);
    for (int k = 2; k >= 0; --k) {
      const double l = eigen.eigenvalues()[k];
      if (!(l > kMoved * eigen.eigenvalues()[2])) continue;
      const Vec3 v = eigen.eigenvectors().col(k);
      const int d = block.directions++;
      block.direction.col(d) = std::sqrt(l) * v;
      block.gain.col(d) = s.uy.transpose() * v / std::sqrt(l);
      block.doubt[d] = std::sqrt(l) * std::hypot(now.doubt, floor * (now.G * v).norm());
    }
    size_ += 3 * block.directions;
    blocks_.push_back(block);
  }
}

void MarkerRows::solve(const MaterialSpec& material) {
  if (!empty())
    gains_ = MarkerGains(experiment_->places, material, markers_->points, exact_regions_);
}

Eigen::VectorXd MarkerRows::residuals(const MaterialSpec& material, double noise,
                                      Eigen::MatrixXd* by) const {
  Eigen::VectorXd r(size_);
  if (by != nullptr) by->setZero();
  std::vector<MarkerGain> here;
  std::size_t position = 0;
  Eigen::Index row = 0;
  for (const Block& block : blocks_) {
    if (here.empty() || block.position != position)
      here = gains_.at(position = block.position, material);
    const MarkerGain& now = here[block.point];
    for (int d = 0; d < block.directions; ++d, row += 3) {
      const double weight = 1 / std::hypot(noise, block.doubt[d]);
      r.segment<3>(row) = weight * (now.G * block.direction.col(d) - block.gain.col(d));
      if (by == nullptr) continue;
      for (const auto& [column, slope] : now.by_column)
        by->block<3, 1>(row, column) += weight * (slope * block.direction.col(d));
    }
  }
  return r;
}

void MarkerRows::append(const Model& model, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
  if (empty()) return;
  const Eigen::Index before = r.size();
  Eigen::MatrixXd by(J != nullptr ? size_ : 0, J != nullptr ? J->cols() : 0);
  const Eigen::VectorXd own = residuals(material_of(model), noise_, J != nullptr ? &by : nullptr);
  r.conservativeResize(before + size_);
  r.tail(size_) = own;
  if (J == nullptr) return;
  J->conservativeResize(before + size_, Eigen::NoChange);
  J->bottomRows(size_) = by;
}

MarkerError MarkerRows::error(const Model& model) const {
  MarkerError error;
  error.unused = unused_;
  if (empty()) return error;
  const MaterialSpec material = material_of(model);
  const auto count = static_cast<double>(size_);
  error.whitened =
      std::sqrt(residuals(material, markers_->noise.value, nullptr).squaredNorm() / count);
  error.most_whitened = std::sqrt(1 + kOnceInThousand * std::sqrt(2 / count));
  error.components = static_cast<std::size_t>(size_);
  error.noise = markers_->noise.value;
  error.noise_origin = markers_->noise.origin;
  std::map<std::size_t, std::pair<double, double>> of_point;  // squares, rows
  double squares = 0, size = 0, off_line = 0, free = 0;
  std::vector<MarkerGain> here;
  std::size_t position = 0;
  for (const Block& block : blocks_) {
    if (here.empty() || block.position != position)
      here = gains_.at(position = block.position, material);
    const double own = block.sums.squares(here[block.point].G);
    auto& [sum, rows] = of_point[block.point];
    sum += own;
    rows += static_cast<double>(block.sums.rows);
    squares += own;
    size += block.sums.yy;
    error.rows += block.sums.rows;
    off_line += std::max(0.0, block.sums.yy - block.gain.leftCols(block.directions).squaredNorm());
    free += 3 * std::max(0.0, static_cast<double>(block.sums.rows) - block.directions);
  }
  const double components = 3 * static_cast<double>(error.rows);
  error.points = of_point.size();
  error.rms = std::sqrt(squares / components);
  error.size = std::sqrt(size / components);
  if (free > 0) error.bent = std::sqrt(off_line / free) / error.noise;
  for (const auto& [point, sums] : of_point)
    if (const double rms = std::sqrt(sums.first / (3 * sums.second)); rms > error.worst_rms) {
      error.worst_rms = rms;
      error.worst = markers_->names[point];
    }
  return error;
}

MarkerError marker_error(const Fit& fitted, const Experiment& experiment,
                         const Selection& selection, const FitOptions& options) {
  return MarkerRows(fitted.model, experiment, selection, options).error(fitted.model);
}

}  // namespace hapsim
