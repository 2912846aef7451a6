// Which numbers of a sensor are asked of its poses, and in which steps.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibrate/sensor_model.h"
#include "estimate/least_squares.h"

namespace hapsim {

// What makes newtons of what the sensor shows: a weight that is known beside the tool's, the tool's
// mass itself, or nothing. Then the mean gain of the three axes is taken for 1, for a heavier tool
// under a sensor of less gain shows the same.
enum class Scale { kKnownWeight, kKnownMass, kMeanGain };

// The groups of numbers that can be fitted or left out.
struct SensorTerms {
  Scale scale = Scale::kMeanGain;
  bool crosstalk = true;  // else one common gain, where the scale is known
  bool drift = false;
  bool gravity = false;  // its direction
  bool torque = false;
  bool torque_drift = false;
  bool weight_at = false;  // where the known weight hangs, from the torques
};

struct SensorUnknowns {
  std::vector<std::string> names;  // of calibrated_names(), or "gravity"
  std::vector<Unknown> unknowns;   // value 0; `scale`: a standard error as large tells nothing
  Eigen::MatrixXd basis;           // kSensorNumbers x unknowns: the change of the state by each
  std::vector<int> group;          // the term of each (SensorGroup)
};
enum SensorGroup { kAlways, kOfCrosstalk, kOfDrift, kOfGravity, kOfTorque, kOfTorqueDrift };

// For a tool of mass `state.mass`.
SensorUnknowns sensor_unknowns(const SensorTerms& terms, const SensorState& state);

}  // namespace hapsim
