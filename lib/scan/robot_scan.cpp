#include "scan/robot_scan.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "scan/table_columns.h"

namespace hapsim {
namespace {

std::string at_line(const CsvTable& table, std::size_t row) {
  return fmt::format("{}:{}", table.name, table.line[row]);
}

void check_limits(const CsvTable& table, std::size_t row, const Robot& robot,
                  const Eigen::VectorXd& q) {
  constexpr double kSlack = 0.1;  // [rad], [m]: an encoder's offset; degrees are far beyond
  for (std::size_t j = 0; j < robot.joints().size(); ++j) {
    const RobotJoint& joint = robot.joints()[j];
    const double value = q[static_cast<Eigen::Index>(j)];
    if (value >= joint.lower - kSlack && value <= joint.upper + kSlack) continue;
    fail_input(at_line(table, row),
               fmt::format("joint {} stands at {:.4g}, beyond its limits {:.4g} to {:.4g} {}",
                           joint.name, value, joint.lower, joint.upper, joint.turns ? "rad" : "m"),
               joint.turns ? "if the angles are in degrees give --angle-unit deg, else mend the "
                             "limits in the URDF"
                           : "check --unit, or mend the limits in the URDF");
  }
}

// Distances [m]; a cell that is no number is NaN where `lost_allowed`.
std::vector<double> distances(const CsvTable& table, const std::string& column, bool lost_allowed) {
  if (!lost_allowed) return table.numbers(column);
  const auto& cells = table.columns[static_cast<std::size_t>(table.find(column))];
  std::vector<double> d(cells.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (!parse_number(cells[i], d[i])) d[i] = NAN;
  }
  return d;
}

}  // namespace

Ray ray_at(const Robot& robot, const Beam& beam, const Eigen::VectorXd& q) {
  const Pose sensor = beam.object.inverse() * robot.forward(q) * beam.mount;
  return {sensor.translation(), sensor.linear() * beam.direction};
}

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

Scan robot_scan(const CsvTable& table, const Robot& robot, const Beam& beam) {
  const std::vector<std::string> columns = joint_columns(table, robot);
  std::vector<std::vector<double>> angles;
  for (const std::string& column : columns) angles.push_back(table.numbers(column));
  const std::string d_column = find_column(table, {"d", "distance", "laser", "range"});
  if (d_column.empty() && beam.bar == 0) {
    fail_missing_column(table.name, "d", table.header, columns);
  }
  std::vector<double> d(table.rows(), beam.bar);
  if (beam.bar == 0) {
    d = distances(table, d_column, beam.range.has_value());
    for (double& v : d) v *= beam.length_factor;
  }

  Scan scan;
  std::vector<int> kept;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool lost =
        beam.range && beam.bar == 0 && !(d[row] >= (*beam.range)[0] && d[row] <= (*beam.range)[1]);
    if (lost) continue;
    if (d[row] < 0) {
      fail_input(at_line(table, row), fmt::format("the distance is negative, {:.4g} m", d[row]),
                 "remove the row, or give --range to drop what the sensor did not see");
    }
    Eigen::VectorXd q(static_cast<Eigen::Index>(angles.size()));
    for (std::size_t j = 0; j < angles.size(); ++j) {
      const double factor = robot.joints()[j].turns ? beam.angle_factor : beam.length_factor;
      q[static_cast<Eigen::Index>(j)] = angles[j][row] * factor;
    }
    check_limits(table, row, robot, q);
    const Ray ray = ray_at(robot, beam, q);
    scan.cloud.points.push_back(ray.origin + d[row] * ray.direction);
    scan.to_sensor.push_back(-ray.direction);
    kept.push_back(static_cast<int>(row));
  }
  if (kept.size() < table.rows()) {
    scan.notes.push_back(fmt::format("{} rows with a distance outside --range left out",
                                     table.rows() - kept.size()));
  }
  take_zones(table, kept, scan);
  take_touch_force(table, kept, scan);
  return scan;
}

}  // namespace hapsim
