// What a plan is made of and what it becomes, as files.
#pragma once

#include <ostream>
#include <vector>

#include "io/stream.h"
#include "scan/plan_scan.h"

namespace hapsim {

// A surface that is known roughly, as points with outward normals about `spacing` [m] apart: a mesh
// (in any format of formats/format_table.h) is sampled, points without normals get them. `unit` in
// metres. Error(kBadInput) as read_scan and read_surface say.
PointCloud read_known_surface(Input& input, double unit, double spacing);

// Places to look at or to touch, one a row in its order; without normals they point up.
PointCloud read_positions(Input& input, double unit);

// CSV q1..qN,d,x,y,z,nx,ny,nz, a row a pose; it can be read again as a robot's scan.
void write_plan(std::ostream& out, const Robot& robot, const std::vector<Target>& targets,
                const ScanPlan& plan, double standoff);

}  // namespace hapsim
