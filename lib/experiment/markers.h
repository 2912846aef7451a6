// Measured displacements of marked surface points beside the presses of a recording.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/marker_gains.h"
#include "recording/marker_table.h"

namespace hapsim {

// Why the model does not say how points of the surface move; "" when it does: then that is a
// constant matrix of place and point times the tool's displacement (MarkerGains). So it is under a
// bonded flat tool that does not turn and moves as recorded, on a body that is linear, of one law
// of relaxation and without layers or inclusions; what the sensor does to the force is nothing to
// the points.
std::string marker_refusal(const Model& model, const Dataset& dataset);

// Sums of what one point showed in one episode, y its displacement and u the tool's: all that least
// squares of y = G u need.
struct MarkerSums {
  std::size_t rows = 0;
  Eigen::Matrix3d uu = Eigen::Matrix3d::Zero();  // of u u' [m^2]
  Eigen::Matrix3d uy = Eigen::Matrix3d::Zero();  // of u y' [m^2]
  double yy = 0;                                 // of |y|^2 [m^2]
  MarkerSums& operator+=(const MarkerSums& other);
  double squares(const Eigen::Matrix3d& G) const;  // of y - G u
};

// Rows of a table of markers beside those of a recording. Complete when it is made.
struct Markers {
  std::vector<std::string> names;
  std::vector<Vec3> points;                   // rest positions on the measured body [m]
  std::vector<std::vector<MarkerSums>> sums;  // [episode][point]
  std::size_t rows = 0;                       // that count
  Noise noise;                                // of a component [m]
  // Sentences: how many rows count, and why others do not.
  std::vector<std::string> words;
};

// The tool's displacement at each row's time is interpolated between the rows of the press before
// and after it, which are both in contact; clocks are taken for one, no offset is sought. Presses
// are told by the column press of `table`, without it by the time, which then must not begin anew.
// Rows of no press, of the air, or of a point under the tool (whose displacement says nothing of
// the body) do not count. Noise is declared (marker_noise), else what is left of the best straight
// lines y = G u, whatever G. Error(kBadInput): a recording without times; points off the surface
// (their number, and the factor where they lie on it in another unit); displacements beyond those
// of the tool (the factor where that is of a unit); no row that counts.
Markers match_markers(const MarkerTable& table, const Experiment& experiment);

// Error(kBadInput) where a point lies farther from the body's surface than contacts may, 2 % of its
// largest extent and at least 1 mm: how many do, and the factor with which they would lie on it.
void require_on_surface(const MarkerTable& table, const Experiment& experiment);

// Of measured less modelled displacements.
struct MarkerError {
  std::size_t rows = 0;
  std::size_t points = 0;
  std::size_t components = 0;                             // of the residuals in which they count
  double rms = std::numeric_limits<double>::quiet_NaN();  // of a component [m]
  double whitened = std::numeric_limits<double>::quiet_NaN();  // MarkerRows; 1: as expected
  // More than that of noise and meshes is met by chance once in a thousand times.
  double most_whitened = std::numeric_limits<double>::quiet_NaN();
  double bent = std::numeric_limits<double>::quiet_NaN();  // rms off any straight line, over noise
  double noise = 0;                                        // [m]
  std::string noise_origin;
  double size = 0;       // rms of a measured component [m]
  std::string worst;     // the point that is farthest off
  double worst_rms = 0;  // [m]
  std::string unused;    // why measured points do not count; "": they do, or were not
};

}  // namespace hapsim
