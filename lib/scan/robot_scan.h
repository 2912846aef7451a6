// Points measured by a robot that carries a laser or a touch probe.
#pragma once

#include <array>
#include <optional>

#include "io/csv.h"
#include "robot/robot.h"
#include "scan/scan.h"

namespace hapsim {

// How the sensor sits on the tip and where its beam goes.
struct Beam {
  Pose mount = Pose::Identity();   // frame of the sensor in the tip's
  Vec3 direction = Vec3::UnitZ();  // of the beam or the bar, in the sensor's frame; unit
  double bar = 0;                  // length of a touch probe along it [m]; 0: a laser
  Pose object = Pose::Identity();  // frame in which points are given, in the robot's root's
  double angle_factor = 1;         // of the table's joint angles to rad
  double length_factor = 1;        // of its distances and sliding joints to m
  std::optional<std::array<double, 2>> range;  // distances outside [m] mean that nothing was seen
};

// Where the beam begins and its direction, in the object's frame.
struct Ray {
  Vec3 origin;
  Vec3 direction;  // unit
};
Ray ray_at(const Robot& robot, const Beam& beam, const Eigen::VectorXd& q);

// p = origin + d direction, one point a row: column d (or distance, laser, range), or the bar's
// length where the table has none. Columns zone and touch_force are taken along. Error(kBadInput):
// a missing column, text or NaN in a joint, a distance that is none (unless `range` is given, which
// drops and counts it), a joint beyond its limits by more than 0.1 rad (angles in degrees?).
Scan robot_scan(const CsvTable& table, const Robot& robot, const Beam& beam);

}  // namespace hapsim
