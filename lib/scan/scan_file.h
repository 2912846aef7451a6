// A scan from any file of points, by content.
#pragma once

#include <string>

#include "scan/robot_scan.h"
#include "scan/scan.h"

namespace hapsim {

struct ScanFileOptions {
  double unit = 1;               // metres in a unit of coordinates and distances
  const Robot* robot = nullptr;  // the table holds joint angles
  Beam beam;                     // with a robot
  bool sections = false;         // the table holds contours, grouped by z
  double section_distance = 0;   // of sections without z [m]
};

// PLY (vertices, normals, zone), STL and OFF (corners), PCD, CSV or rows of numbers (x y z [nx ny
// nz]; case does not matter, pos_x, point_x, normal_x do too); CSV with a column `section` or
// `slice` holds contours; with a robot, CSV of joint angles. Columns zone and touch_force are taken
// along. No point is Error(kBadInput, name), as is what the readers refuse; a volume is
// Error(kUsage), as it needs a threshold.
Scan read_scan(Input& input, const ScanFileOptions& options);

// Fails when the middle 96 % of the points span more than 5 m or less than 1 mm: `unit` (as the
// user named it) is hardly right.
void check_extent(const std::vector<Vec3>& points, const std::string& unit,
                  const std::string& name);

// Scales normals to unit length; a missing (zero) or infinite one makes all of them worthless:
// then they are dropped.
void accept_normals(PointCloud& cloud);

}  // namespace hapsim
