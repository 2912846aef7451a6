// A fit as the calibration that is written: numbers with intervals.
#pragma once

#include <Eigen/Core>

#include "calibrate/sensor_fit.h"
#include "rig/calibration.h"

namespace hapsim {

// Derivatives of a calibration's numbers by the unknowns of a fit: kCalibratedNumbers rows. The
// numbers' covariance is D covariance D'.
Eigen::MatrixXd number_slopes(const SensorFit& fit);

// Intervals of kCalibrationConfidence: Student's t of the degrees of freedom of forces, or of
// torques. Metadata: poses, scale (what makes newtons of what the sensor shows), force_noise,
// torque_noise, temp_ref, temp_range.
Calibration calibration_of(const SensorFit& fit, const StaticPoses& poses,
                           const SensorOptions& options);

// The numbers of a state, without intervals.
Calibration calibration_of(const SensorState& state);

}  // namespace hapsim
