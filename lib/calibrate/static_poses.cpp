#include "calibrate/static_poses.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "io/csv.h"
#include "io/number.h"
#include "rig/orientation.h"
#include "robot/joint_table.h"

namespace hapsim {
namespace {

std::string at_line(const CsvTable& table, std::size_t row) {
  return fmt::format("{}:{}", table.name, table.line[row]);
}

std::vector<Eigen::Matrix3d> orientations(const CsvTable& table, const Robot* robot,
                                          double angle_factor) {
  if (robot == nullptr) {
    auto all = read_orientations({table.name, table.header, table.columns, table.line});
    if (all.empty())
      fail_input(table.name, "no columns say how the tool was turned",
                 "give " + orientation_columns() + "; or joint angles, with --robot FILE.urdf");
    return all;
  }
  std::vector<Eigen::Matrix3d> all;
  const JointTable joints = read_joints(table, *robot, angle_factor);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    check_limits(*robot, joints.q[row], at_line(table, row));
    all.push_back(robot->forward(joints.q[row]).linear());
  }
  return all;
}

// Three columns as vectors; none where the first is not there and need not be.
std::vector<Vec3> vectors(const CsvTable& table, const std::string& letter, bool needed) {
  std::vector<Vec3> all;
  if (!needed && table.find(letter + "x") < 0) return all;
  all.resize(table.rows());
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> values = table.numbers(letter + "xyz"[axis]);
    for (std::size_t row = 0; row < all.size(); ++row) all[row][axis] = values[row];
  }
  return all;
}

std::vector<double> scalars(const CsvTable& table, const std::string& column) {
  return table.find(column) < 0 ? std::vector<double>{} : table.numbers(column);
}

void check_loads(const CsvTable& table, const std::vector<double>& loads) {
  for (std::size_t row = 0; row < loads.size(); ++row)
    if (!(loads[row] >= 0 && loads[row] <= 1000))
      fail_input(at_line(table, row), fmt::format("load is {} kg", format_number(loads[row])),
                 "give the added weight in kg, 0 where there is none");
}

// The mean of the rows of each pose.
class Poses {
 public:
  void add(const std::string& key, const StaticPose& row) {
    const auto [found, is_new] = index_.try_emplace(key, sums_.size());
    if (is_new) {
      sums_.push_back(row);
      counts_.push_back(1);
      return;
    }
    StaticPose& sum = sums_[found->second];
    sum.orientation += row.orientation;
    sum.force += row.force;
    sum.torque += row.torque;
    sum.temp += row.temp;
    sum.load += row.load;
    counts_[found->second] += 1;
  }
  std::vector<StaticPose> means() {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      StaticPose& p = sums_[i];
      p.force /= counts_[i];
      p.torque /= counts_[i];
      p.temp /= counts_[i];
      p.load /= counts_[i];
      if (counts_[i] > 1) p.orientation = nearest_rotation(p.orientation);
    }
    return std::move(sums_);
  }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<StaticPose> sums_;
  std::vector<double> counts_;
};

}  // namespace

StaticPoses read_static_poses(Input& input, const Robot* robot, double angle_factor) {
  const CsvTable table = read_csv(input);
  if (table.rows() == 0)
    fail_input(table.name, "there is a header but no data row", "add the recorded poses");
  const std::vector<Vec3> force = vectors(table, "f", true), torque = vectors(table, "t", false);
  const std::vector<double> temp = scalars(table, "temp"), load = scalars(table, "load");
  check_loads(table, load);
  const std::vector<Eigen::Matrix3d> turned = orientations(table, robot, angle_factor);
  const int pose = table.find("pose");
  StaticPoses result{.name = table.name, .metadata = table.metadata, .rows = table.rows()};
  result.torques = !torque.empty();
  result.temps = !temp.empty();
  result.loads = !load.empty();
  Poses poses;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    StaticPose p{.line = table.line[row], .orientation = turned[row], .force = force[row]};
    if (result.torques) p.torque = torque[row];
    if (result.temps) p.temp = temp[row];
    if (result.loads) p.load = load[row];
    constexpr double kSame = 1e-3;  // [rad]
    if (pose < 0 && row > 0 && (turned[row] - turned[row - 1]).norm() < kSame &&
        (load.empty() || load[row] == load[row - 1]))
      ++result.repeated;
    poses.add(pose < 0 ? std::to_string(row) : table.columns[static_cast<std::size_t>(pose)][row],
              p);
  }
  result.poses = poses.means();
  return result;
}

}  // namespace hapsim
