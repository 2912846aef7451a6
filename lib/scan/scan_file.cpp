#include "scan/scan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "containers/ply.h"
#include "formats/format_table.h"
#include "formats/surface_io.h"
#include "scan/sections.h"
#include "scan/table_columns.h"
#include "volume/volume.h"

namespace hapsim {
namespace {

void take_ply_zones(const std::string& bytes, const std::string& name, Scan& scan) {
  const PlyFile file = parse_ply(bytes, name);
  const PlyElement* vertex = file.find("vertex");
  const PlyProperty* zone = vertex == nullptr ? nullptr : vertex->find("zone");
  if (zone == nullptr || zone->is_list) return;
  for (const double z : zone->values) {
    const std::string text = format_number(z);
    const auto at = std::find(scan.zone_names.begin(), scan.zone_names.end(), text);
    scan.zone.push_back(static_cast<int>(at - scan.zone_names.begin()));
    if (at == scan.zone_names.end()) scan.zone_names.push_back(text);
  }
}

Scan table_scan(const CsvTable& table, const ScanFileOptions& options) {
  if (options.robot != nullptr) return robot_scan(table, *options.robot, options.beam);
  if (options.sections || !find_column(table, {"section", "slice"}).empty()) {
    return sections_scan(read_sections(table, options.unit, options.section_distance));
  }
  Scan scan;
  // A name that is not there stands for itself in the message.
  const auto name = [&table](const char* axis, const char* wanted) {
    const std::string a = axis;
    const std::string found = wanted[0] == 'n'
                                  ? find_column(table, {"n" + a, "normal_" + a, "normal" + a})
                                  : find_column(table, {a, "p" + a, "pos_" + a, "point_" + a});
    return found.empty() ? wanted : found;
  };
  scan.cloud.points = vector_columns(table, name("x", "x"), name("y", "y"), name("z", "z"));
  const std::string nx = name("x", "nx"), ny = name("y", "ny"), nz = name("z", "nz");
  if (table.find(nx) >= 0 && table.find(ny) >= 0 && table.find(nz) >= 0) {
    scan.cloud.normals = vector_columns(table, nx, ny, nz);
  }
  for (Vec3& p : scan.cloud.points) p *= options.unit;
  std::vector<int> all(table.rows());
  std::iota(all.begin(), all.end(), 0);
  take_zones(table, all, scan);
  take_touch_force(table, all, scan);
  return scan;
}

}  // namespace

Scan read_scan(Input& input, const ScanFileOptions& options) {
  const std::string name = input.name();
  std::string bytes = input.read_all();
  Scan scan;
  if (looks_like_volume(bytes)) fail_no_threshold(read_volume(bytes, name), name);
  // Tables are read here: they may hold joint angles or contours as well as points.
  const Recognised found = recognise(bytes);
  const bool is_table =
      found.format == &csv_format() || (found.format == &rows_format() && options.robot != nullptr);
  if (is_table) {
    Input again = Input::from_bytes(std::move(bytes), name);
    scan = table_scan(read_csv(again), options);
  } else {
    scan.cloud = parse_points(bytes, name, &scan.notes);
    for (Vec3& p : scan.cloud.points) p *= options.unit;
    if (is_ply(bytes)) take_ply_zones(bytes, name, scan);
  }
  if (scan.cloud.points.empty()) fail_input(name, "there are no points", "give rows of x,y,z");
  accept_normals(scan.cloud);
  return scan;
}

void check_extent(const std::vector<Vec3>& points, const std::string& unit,
                  const std::string& name) {
  double size = 0;
  std::vector<double> along(points.size());
  const auto cut = static_cast<std::size_t>(0.02 * static_cast<double>(points.size()));
  for (int k = 0; k < 3 && !points.empty(); ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i][k];
    std::sort(along.begin(), along.end());
    size = std::max(size, along[along.size() - 1 - cut] - along[cut]);
  }
  if (size > 5) {
    fail_input(name, fmt::format("the scan is {:.3g} m wide when read in {}", size, unit),
               "give its unit, as --unit mm");
  }
  if (size < 1e-3 && size > 0) {
    fail_input(name, fmt::format("the scan is {:.3g} mm wide when read in {}", 1e3 * size, unit),
               "give its unit, as --unit m");
  }
}

void accept_normals(PointCloud& cloud) {
  for (Vec3& n : cloud.normals) {
    const double length = n.norm();
    if (!(length > 1e-6 && std::isfinite(length))) {
      cloud.normals.clear();
      return;
    }
    n /= length;
  }
}

}  // namespace hapsim
