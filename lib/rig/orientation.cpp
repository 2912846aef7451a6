#include "rig/orientation.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/vec3.h"
#include "io/csv.h"
#include "io/number.h"
#include "rig/rotation_vector.h"

namespace hapsim {
namespace {

constexpr double kLoose = 0.02;   // numbers of few digits
constexpr double kMostAngle = 7;  // [rad]; beyond it they are degrees
using Numbers = std::array<double, 9>;

Eigen::Matrix3d of_quaternion(const Numbers& v, const std::string& where) {
  const Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
  if (std::abs(q.norm() - 1) > kLoose)
    fail_input(where, fmt::format("the quaternion has length {:.4g}, not 1", q.norm()),
               "give qw,qx,qy,qz of the tool in the robot's base");
  return q.normalized().toRotationMatrix();
}

Eigen::Matrix3d of_matrix(const Numbers& v, const std::string& where) {
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(v.data());
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R);
  if ((svd.singularValues() - Vec3::Ones()).cwiseAbs().maxCoeff() > kLoose || R.determinant() < 0)
    fail_input(where, "r11 to r33 are no rotation",
               "rij is row i, column j of the tool's axes (columns) in the robot's base");
  return nearest_rotation(R);
}

void check_angles(const Numbers& v, const std::string& where) {
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(v[k]) > kMostAngle)
      fail_input(where, fmt::format("an angle of the orientation is {:.4g} rad", v[k]),
                 "are these degrees? multiply them by 0.0174533");
}

Eigen::Matrix3d of_vector(const Numbers& v, const std::string& where) {
  check_angles(v, where);
  return rotation_of({v[0], v[1], v[2]});
}

Eigen::Matrix3d of_angles(const Numbers& v, const std::string& where) {
  check_angles(v, where);
  return rotation_of({0, 0, v[2]}) * rotation_of({0, v[1], 0}) * rotation_of({v[0], 0, 0});
}

struct Convention {
  std::vector<std::string> columns;
  Eigen::Matrix3d (*orientation)(const Numbers& v, const std::string& where);
};
const std::vector<Convention>& conventions() {
  static const std::vector<Convention> all{
      {{"qw", "qx", "qy", "qz"}, of_quaternion},
      {{"r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"}, of_matrix},
      {{"rotvec_x", "rotvec_y", "rotvec_z"}, of_vector},
      {{"roll", "pitch", "yaw"}, of_angles}};
  return all;
}

std::vector<Eigen::Matrix3d> read(const TextColumns& table, const Convention& convention) {
  std::vector<std::size_t> at;
  for (const std::string& column : convention.columns) {
    const auto found = std::find(table.header.begin(), table.header.end(), column);
    if (found == table.header.end())
      fail_missing_column(table.name, column, table.header, convention.columns);
    at.push_back(static_cast<std::size_t>(found - table.header.begin()));
  }
  std::vector<Eigen::Matrix3d> all;
  BadCells bad;
  for (std::size_t row = 0; row < table.line.size() && !bad.full(); ++row) {
    Numbers v{};
    bool good = true;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const std::string& cell = table.columns[at[k]][row];
      if (parse_number(cell, v[k])) continue;
      bad.add(convention.columns[k], table.line[row], cell);
      good = false;
    }
    if (good)
      all.push_back(convention.orientation(v, fmt::format("{}:{}", table.name, table.line[row])));
  }
  bad.fail_if_any(table.name);
  return all;
}

}  // namespace

std::vector<Eigen::Matrix3d> read_orientations(const TextColumns& table) {
  const auto has = [&table](const std::string& column) {
    return std::find(table.header.begin(), table.header.end(), column) != table.header.end();
  };
  // A set that is begun is meant: what it lacks is told, unless another one is whole.
  const Convention* begun = nullptr;
  for (const Convention& c : conventions()) {
    if (std::all_of(c.columns.begin(), c.columns.end(), has)) return read(table, c);
    if (begun == nullptr && has(c.columns.front())) begun = &c;
  }
  return begun == nullptr ? std::vector<Eigen::Matrix3d>{} : read(table, *begun);
}

Eigen::Matrix3d orientation_of(const std::string& quaternion, const std::string& where) {
  Numbers v{};
  std::size_t from = 0, count = 0;
  while (count < 4 && from <= quaternion.size()) {
    const std::size_t to = std::min(quaternion.find(',', from), quaternion.size());
    if (!parse_number(std::string_view(quaternion).substr(from, to - from), v[count])) break;
    ++count;
    from = to + 1;
  }
  if (count != 4 || from <= quaternion.size())
    fail_input(where, "the metadata orientation is " + shown(quaternion),
               "write qw,qx,qy,qz of the tool in the robot's base, as 1,0,0,0");
  return of_quaternion(v, where);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

std::string orientation_columns() {
  std::string all;
  for (const Convention& c : conventions()) {
    if (!all.empty()) all += "; ";
    if (c.columns.size() > 4) {
      all += c.columns.front() + ",...," + c.columns.back();
      continue;
    }
    for (std::size_t k = 0; k < c.columns.size(); ++k) all += (k > 0 ? "," : "") + c.columns[k];
  }
  return all;
}

}  // namespace hapsim
