// Joint values in tables.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"
#include "robot/robot.h"

namespace hapsim {

struct JointTable {
  std::vector<std::string> columns;  // that hold the joints, in the robot's order
  std::vector<Eigen::VectorXd> q;    // of each row [rad], [m] of sliding joints
};

// From the columns of the joints' names, else q1..qN, or joint1.., theta1.., alpha1.. (any case,
// "_" or space before the number), times the factors to rad and m. Error(kBadInput): a missing
// column, text or NaN, one joint more than the robot has.
JointTable read_joints(const CsvTable& table, const Robot& robot, double angle_factor,
                       double length_factor = 1);

// Error(kBadInput) at `where`: a joint beyond its limits by more than 0.1 rad or m (degrees?).
void check_limits(const Robot& robot, const Eigen::VectorXd& q, const std::string& where);

}  // namespace hapsim
