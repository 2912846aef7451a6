// What a force sensor shows of a tool that hangs still, and how that changes with each number.
#pragma once

#include <Eigen/Core>

#include "calibrate/static_poses.h"

namespace hapsim {

using Matrix32 = Eigen::Matrix<double, 3, 2>;

// The model of rig/calibration.h. What is fitted counts from it: rotation and gravity by small
// turns.
struct SensorState {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();   // tool's frame to the sensor's
  Eigen::Matrix3d crosstalk = Eigen::Matrix3d::Identity();  // symmetric
  double sign = 1;
  double mass = 1;  // [kg]
  Vec3 gravity = Vec3(0, 0, -9.80665);
  Vec3 offset = Vec3::Zero(), drift = Vec3::Zero();
  Vec3 com = Vec3::Zero();
  Vec3 torque_offset = Vec3::Zero(), torque_drift = Vec3::Zero();
  Vec3 weight_at = Vec3::Zero();
  double temp_ref = 0;
};

// The numbers by which a state can change.
enum SensorNumber {
  kTurn = 0,  // w: rotation = exp([w]x) rotation, in the sensor's frame [rad]
  kTalk = 3,  // xx, yy, zz, xy, xz, yz
  kToolMass = 9,
  kTilt = 10,  // two: gravity = exp([T t]x) gravity, T = tilt_axes(gravity) [rad]
  kZero = 12,
  kZeroDrift = 15,
  kCentre = 18,
  kTorqueZero = 21,
  kTorqueZeroDrift = 24,
  kHung = 27,
  kSensorNumbers = 30
};

// Two unit vectors square to gravity and to each other.
Matrix32 tilt_axes(const Vec3& gravity);

// The state moved by d.
SensorState moved(const SensorState& state, const Eigen::VectorXd& d);

struct Wrench {
  Eigen::Matrix<double, 6, 1> value;               // force [N], then torque [N m]
  Eigen::Matrix<double, 6, kSensorNumbers> slope;  // by the numbers, at d = 0
};
Wrench shown_wrench(const SensorState& state, const StaticPose& pose);

}  // namespace hapsim
