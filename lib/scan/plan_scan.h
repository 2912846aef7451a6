// Joint angles for a robot that is to scan or touch a surface.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scan/robot_scan.h"

namespace hapsim {

// A place to look at or to touch.
struct Target {
  Vec3 point;   // in the object's frame [m]
  Vec3 normal;  // outward, unit: the beam comes against it
};

// ScanPlan view x0, y0, x1, y1 in the object's frame [m].
using Region = std::array<double, 4>;

// Places on a known surface, given by points with normals: one a cubic cell of `pitch` [m] (the
// mean of its points), those in `region` whose normal is less than `steepest` [rad] off z, in rows
// along x that turn back at their ends.
std::vector<Target> raster_on_surface(const PointCloud& cloud, double pitch,
                                      const std::optional<Region>& region, double steepest);

// Places at the height z = `height`, `pitch` apart in both directions, normal z, in such rows.
std::vector<Target> raster_on_grid(const Region& region, double pitch, double height);

struct PlannedPose {
  int target = 0;
  Eigen::VectorXd q;
};

struct ScanPlan {
  std::vector<PlannedPose> poses;
  std::vector<int> unreachable;  // targets
};

// For each target the joint values that put the beam's origin `standoff` [m] off the point along
// its normal, beam against the normal. The turn about the beam is free: the one that moves the
// joints least from the pose before is taken, of every 45 degrees. Neither collisions nor the way
// between poses are checked.
ScanPlan plan_scan(const Robot& robot, const Beam& beam, double standoff,
                   const std::vector<Target>& targets);

// Evenly spread points (about `spacing` [m]) with normals on the faces of a surface.
PointCloud sample_surface(const Surface& surface, double spacing);

}  // namespace hapsim
