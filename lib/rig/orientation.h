// How the tool was turned, row by row, as tables write it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hapsim {

// The text of a table, seen column by column.
struct TextColumns {
  const std::string& name;  // of the source, for error messages
  const std::vector<std::string>& header;
  const std::vector<std::vector<std::string>>& columns;  // columns[c][row]
  const std::vector<long>& line;                         // line[row] in the source
};

// R of each row, with f_base = R f_tool: the tool's axes in the robot's base are its columns. From
// the first of these sets of columns that the table has: qw,qx,qy,qz (quaternion); r11,r12,...,r33
// (row, column); rotvec_x,rotvec_y,rotvec_z (axis times angle [rad]); roll,pitch,yaw about the
// fixed x, y, z [rad], as in URDF. Empty where it has none. Error(kBadInput): a part of a set,
// text, a quaternion whose length is not 1, a matrix that is no rotation (both to 2 %), angles
// beyond 7 rad.
std::vector<Eigen::Matrix3d> read_orientations(const TextColumns& table);

// Of "qw,qx,qy,qz", the metadata `orientation` of a recording whose tool never turns. Errors as
// above.
Eigen::Matrix3d orientation_of(const std::string& quaternion, const std::string& where);

// The rotation nearest to M (singular values all 1), as of a mean of rotations.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& M);

// The names of the sets, for errors and help: "qw,qx,qy,qz; r11,...,r33; ...".
std::string orientation_columns();

}  // namespace hapsim
