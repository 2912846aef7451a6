#include "scan/plan_file.h"

#include "base/error.h"
#include "formats/format_table.h"
#include "formats/surface_io.h"
#include "io/csv.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/normals.h"
#include "scan/scan_file.h"

namespace hapsim {
PointCloud read_known_surface(Input& input, double unit, double spacing) {
  const std::string bytes = input.read_all();
  const Content content = recognise(bytes).content;
  if (content == Content::kTriangles || content == Content::kTetrahedra) {
    Surface surface = parse_surface(bytes, input.name());
    for (Vec3& p : surface.vertices) p *= unit;
    if (!(surface_area(surface) < 1e7 * spacing * spacing)) {
      fail_input(input.name(), "the surface is too large for this pitch",
                 "check --unit, or give a larger --pitch");
    }
    return sample_surface(surface, spacing);
  }
  Input again = Input::from_bytes(bytes, input.name());
  PointCloud cloud = read_scan(again, {.unit = unit}).cloud;
  if (cloud.normals.empty()) {
    require_surface_points(cloud.points, input.name());
    NormalsReport report;
    estimate_normals(cloud, Vec3::UnitZ(), report);
  }
  return cloud;
}

PointCloud read_positions(Input& input, double unit) {
  PointCloud cloud = read_scan(input, {.unit = unit}).cloud;
  if (cloud.normals.empty()) cloud.normals.assign(cloud.points.size(), Vec3::UnitZ());
  return cloud;
}

void write_plan(std::ostream& out, const Robot& robot, const std::vector<Target>& targets,
                const ScanPlan& plan, double standoff) {
  Metadata metadata;
  metadata.set("robot", robot.name());
  metadata.set("tip", robot.tip());
  std::vector<std::string> header;
  for (std::size_t j = 1; j <= robot.joints().size(); ++j) {
    header.push_back("q" + std::to_string(j));
  }
  for (const char* name : {"d", "x", "y", "z", "nx", "ny", "nz"}) header.emplace_back(name);
  CsvWriter writer(out, metadata, header);
  for (const PlannedPose& planned : plan.poses) {
    const Target& target = targets[static_cast<std::size_t>(planned.target)];
    std::vector<std::string> row;
    for (const double q : planned.q) row.push_back(format_number(q));
    row.push_back(format_number(standoff));
    for (const Vec3* v : {&target.point, &target.normal}) {
      for (int k = 0; k < 3; ++k) row.push_back(format_number((*v)[k]));
    }
    writer.row(row);
  }
}

}  // namespace hapsim
