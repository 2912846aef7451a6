// What a measuring rig does to forces and displacements: the numbers of its calibration.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

// Where a quantity's numbers stand in a calibration, x, y, z in this order; of a symmetric matrix
// xx, yy, zz, xy, xz, yz.
enum CalibratedNumber {
  kRotation = 0,
  kCrosstalk = 3,
  kMass = 9,
  kGravity = 10,
  kOffset = 13,
  kDrift = 16,
  kCom = 19,
  kTorqueOffset = 22,
  kTorqueDrift = 25,
  kWeightAt = 28,
  kArm = 31,
  kCalibratedNumbers = 37
};
inline constexpr std::size_t kSymmetric = 6;
struct MatrixPlace {
  int row, column;
};
// Of the six numbers of a symmetric matrix.
inline constexpr std::array<MatrixPlace, kSymmetric> kSymmetricPlaces{
    {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

struct CalibratedName {
  const char* name;
  const char* unit;
  const char* meaning;
};
// "offset_x", "N", "force that the sensor shows without load".
const std::array<CalibratedName, kCalibratedNumbers>& calibrated_names();

// With what confidence its numbers' intervals are written.
inline constexpr double kCalibrationConfidence = 0.95;

struct CalibratedValue {
  double value = 0;
  double std_error = std::numeric_limits<double>::quiet_NaN();
  double lower = std::numeric_limits<double>::quiet_NaN();  // of the interval
  double upper = std::numeric_limits<double>::quiet_NaN();
  std::string state;  // fitted, given, assumed (not determined); "" where the calibration has none
};

// A force sensor and the arm that carries it. In the tool's frame, with R_tool its orientation in
// the base, m the tool's mass, g gravity in the base, f the force of the body on the tool:
//   measured force  = C R (R_tool^T (m g + f)) + offset + drift (temp - temp_ref)
//   measured torque = s R (com x R_tool^T m g + ...) + torque_offset + torque_drift (temp -
//   temp_ref)
// R = exp([rotation]x) turns the tool's frame into the sensor's; C (crosstalk) is symmetric, for
// what of it is not is a rotation (polar decomposition: Higham, SIAM J. Sci. Stat. Comput. 7,
// 1986); s is its sign, -1 for a sensor that shows the force of the tool on the body.
//   displacement of the tool = recorded + S f, S (arm) symmetric, along the recording's axes
struct Calibration {
  std::string name;  // of the source
  Metadata metadata;
  std::array<CalibratedValue, kCalibratedNumbers> numbers;

  bool has(CalibratedNumber first) const { return !numbers[first].state.empty(); }
  bool has_sensor() const { return has(kRotation); }
  Vec3 vector(CalibratedNumber first) const;
  Eigen::Matrix3d symmetric(CalibratedNumber first) const;
  Eigen::Matrix3d rotation() const;   // R
  Eigen::Matrix3d crosstalk() const;  // C; the identity where there is none
  double sign() const;                // s
  double temp_ref() const;            // metadata; 0 where there is no drift
};

// CSV parameter,value,unit,std_error,lower,upper,state under the metadata. Error(kBadInput) with
// the line: no such parameter (with the nearest), twice the same, a part of a vector or matrix,
// another unit, a cross-talk that cannot be undone, a negative mass.
Calibration read_calibration(Input& input);
void write_calibration(std::ostream& out, const Calibration& calibration);

}  // namespace hapsim
