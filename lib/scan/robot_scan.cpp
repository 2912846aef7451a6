#include "scan/robot_scan.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "robot/joint_table.h"
#include "scan/table_columns.h"

namespace hapsim {
namespace {

std::string at_line(const CsvTable& table, std::size_t row) {
  return fmt::format("{}:{}", table.name, table.line[row]);
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

Scan robot_scan(const CsvTable& table, const Robot& robot, const Beam& beam) {
  const JointTable joints = read_joints(table, robot, beam.angle_factor, beam.length_factor);
  const std::string d_column = find_column(table, {"d", "distance", "laser", "range"});
  if (d_column.empty() && beam.bar == 0) {
    fail_missing_column(table.name, "d", table.header, joints.columns);
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
    const Eigen::VectorXd& q = joints.q[row];
    check_limits(robot, q, at_line(table, row));
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
