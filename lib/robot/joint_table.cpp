#include "robot/joint_table.h"

#include <fmt/format.h>

#include "base/error.h"
#include "io/find_column.h"

namespace hapsim {
namespace {

std::vector<std::string> joint_columns(const CsvTable& table, const Robot& robot) {
  std::vector<std::string> columns;
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    std::vector<std::string> names{robot.joints()[j].name};
    for (const char* word : {"q", "joint", "j", "theta", "alpha", "angle"}) {
      for (const char* between : {"", "_", " "}) {
        names.push_back(word + (between + std::to_string(j + 1)));
      }
    }
    const std::string column = find_column(table, names);
    if (column.empty()) {
      fail_missing_column(table.name, "q" + std::to_string(j + 1), table.header, columns);
    }
    columns.push_back(column);
  }
  // One joint more than the robot's: another robot, or another tip.
  const std::string next = "q" + std::to_string(columns.size() + 1);
  if (!find_column(table, {next}).empty()) {
    fail_input(table.name,
               fmt::format("there is a column {} but {} moves only {} joints up to link {}", next,
                           robot.name(), columns.size(), robot.tip()),
               "give the robot that was used, or another --tip-link");
  }
  return columns;
}

}  // namespace

JointTable read_joints(const CsvTable& table, const Robot& robot, double angle_factor,
                       double length_factor) {
  JointTable joints;
  joints.columns = joint_columns(table, robot);
  joints.q.assign(table.rows(), Eigen::VectorXd(joints.columns.size()));
  for (std::size_t j = 0; j < joints.columns.size(); ++j) {
    const std::vector<double> values = table.numbers(joints.columns[j]);
    const double factor = robot.joints()[j].turns ? angle_factor : length_factor;
    for (std::size_t row = 0; row < values.size(); ++row)
      joints.q[row][static_cast<Eigen::Index>(j)] = factor * values[row];
  }
  return joints;
}

void check_limits(const Robot& robot, const Eigen::VectorXd& q, const std::string& where) {
  constexpr double kSlack = 0.1;  // [rad], [m]: an encoder's offset; degrees are far beyond
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    const RobotJoint& joint = robot.joints()[j];
    const double value = q[static_cast<Eigen::Index>(j)];
    if (value >= joint.lower - kSlack && value <= joint.upper + kSlack) continue;
    fail_input(where,
               fmt::format("joint {} stands at {:.4g}, beyond its limits {:.4g} to {:.4g} {}",
                           joint.name, value, joint.lower, joint.upper, joint.turns ? "rad" : "m"),
               joint.turns ? "if the angles are in degrees give --angle-unit deg, else mend the "
                             "limits in the URDF"
                           : "check --unit, or mend the limits in the URDF");
  }
}

}  // namespace hapsim
