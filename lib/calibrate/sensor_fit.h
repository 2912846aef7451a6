// A force sensor from what it shows in poses at rest.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/sensor_model.h"
#include "calibrate/sensor_unknowns.h"
#include "estimate/identifiability.h"

namespace hapsim {

struct SensorOptions {
  std::string crosstalk = "auto";                      // where the poses determine it; "on", "off"
  std::optional<double> mass;                          // of the tool, weighed [kg]
  std::optional<Vec3> gravity = Vec3(0, 0, -9.80665);  // in the base [m/s2]; none: its direction is
                                                       // fitted
};

struct SensorFit {
  bool determined = false;  // else `blind` says what the poses leave open, and the rest is a start
  SensorTerms terms;
  SensorState state;
  SensorUnknowns unknowns;
  Eigen::MatrixXd covariance;  // of the unknowns
  // Standard deviation of a component [N], [N m], and the degrees of freedom it is known by.
  double force_noise = 0, torque_noise = 0, force_freedom = 0, torque_freedom = 0;
  std::vector<BlindDirection> blind;
  std::vector<SensorGroup> left_out;  // terms that the poses do not determine
  Eigen::MatrixXd residual;  // measured minus shown: a row a pose, 3 or 6 columns [N], [N m]
};

// Least squares (Gauss-Newton) in all numbers together, forces and torques weighted by their own
// noise, which is estimated from the residuals over the degrees of freedom that are left to each.
// The covariance is that of the linearised fit. A term that the poses do not determine (a standard
// error as large as SensorUnknowns' scale) is left out, the worst first; rotation, mass and offset
// cannot be. Never fails: `determined` says whether it could be done.
SensorFit fit_sensor(const StaticPoses& poses, const SensorOptions& options);

// What a fit of these poses would ask for.
SensorTerms wanted_terms(const StaticPoses& poses, const SensorOptions& options);

// Derivatives of what is shown by the unknowns, over the noise: 3 or 6 rows a pose.
Eigen::MatrixXd whitened_slopes(const SensorState& state, const SensorUnknowns& unknowns,
                                const std::vector<StaticPose>& poses, double force_noise,
                                double torque_noise);

}  // namespace hapsim
