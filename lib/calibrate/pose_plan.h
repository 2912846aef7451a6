// Which poses to record next.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/sensor_fit.h"
#include "robot/robot.h"

namespace hapsim {

struct PosePlanOptions {
  std::size_t poses = 6;
  double tilt = 3.2;             // of the tool from the first pose, at most [rad]
  const Robot* robot = nullptr;  // candidates are its joint values within the limits
};

struct PlannedPose {
  Eigen::VectorXd q;            // of the robot; empty without one
  Eigen::Matrix3d orientation;  // of the tool in the base
  Vec3 down;                    // direction of gravity in the tool's frame, unit
  double load = 0;              // [kg]
  std::string tells;            // of what it lowers the standard error most
};

struct PosePlan {
  std::vector<PlannedPose> poses;
  std::vector<std::string> names;  // of the unknowns
  std::vector<std::string> units;  // of their standard errors
  Eigen::VectorXd error_now, error_then;
  Eigen::VectorXd known_below;  // an error above it is none that tells anything
};

// D-optimal additions (Fedorov, Theory of Optimal Experiments, 1972): each pose in turn is the
// candidate by which the determinant of the information about all that is asked for grows most, at
// the numbers known so far. What is not determined yet has a wide prior (ten times the error at
// which it would be determined). Candidates: the directions of gravity in the tool's frame, spread
// over the sphere, or the robot's joints at random within their limits; each without and with the
// largest weight that the poses have. Without poses (`poses.poses` empty) the tool is one that
// hangs straight in a sensor of noise 1e-3 of its weight.
PosePlan plan_poses(const StaticPoses& poses, const SensorFit& fit, const SensorOptions& options,
                    const PosePlanOptions& plan);

// CSV pose[,q1,...],qw,qx,qy,qz,down_x,down_y,down_z[,load],tells.
void write_pose_plan(std::ostream& out, const PosePlan& plan, bool loads);

}  // namespace hapsim
