// Measured displacements of surface points as rows of a fit beside the forces.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"

namespace hapsim {

// The marked points of a selection, and what a model says of them. Empty where there are none or
// the model does not say where they go.
//
// A point's displacement is y = G u with one G a place, so of all its rows there three are left, on
// the principal directions v of the tool's displacements: with l the sum of (u v)^2, the rows
// sqrt(l) (G v - y_v), y_v the least-squares gain of that direction. Each component has the
// variance noise^2 + l doubt^2: a gain is worth what the meshes and the floor of the stiffness
// (relative, of its size) let it be. Where the start leaves so many times of the forces what noise
// and floor let it, the noise of points counts as many times larger: a model that is wrong in shape
// weighs both by its misfit.
class MarkerRows {
 public:
  MarkerRows() = default;
  MarkerRows(const Model& start, const Experiment& experiment, const Selection& selection,
             const FitOptions& options);

  bool empty() const { return blocks_.empty(); }
  Eigen::Index size() const { return size_; }

  // The gains anew, for the regions of this material.
  void solve(const MaterialSpec& material);
  // Whitened residuals (model less measured) after the others, and their derivatives where `J` is
  // wanted.
  void append(const Model& model, Eigen::VectorXd& r, Eigen::MatrixXd* J) const;
  MarkerError error(const Model& model) const;

 private:
  struct Block {  // a point at a place
    std::size_t position = 0, point = 0;
    MarkerSums sums;
    Eigen::Matrix3d direction;  // columns v sqrt(l), of those that were moved the first
    Eigen::Matrix3d gain;       // columns y_v sqrt(l)
    Eigen::Vector3d doubt;      // standard deviation of a component, by direction [m]
    int directions = 0;
  };
  // Of every block: model less measured, over the noise and the doubt of the gain.
  Eigen::VectorXd residuals(const MaterialSpec& material, double noise, Eigen::MatrixXd* by) const;

  const Experiment* experiment_ = nullptr;
  const Markers* markers_ = nullptr;
  bool exact_regions_ = true;
  double noise_ = 0;  // with which they count [m]
  MarkerGains gains_;
  std::vector<Block> blocks_;  // in the order of positions
  Eigen::Index size_ = 0;
  std::string unused_;  // why measured points do not count
};

// What a fitted model leaves of marked points, whether or not they counted in its fit.
MarkerError marker_error(const Fit& fitted, const Experiment& experiment,
                         const Selection& selection, const FitOptions& options);

}  // namespace hapsim
