#include "scan/scan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/median.h"
#include "containers/ply.h"
#include "formats/format_table.h"
#include "formats/surface_io.h"
#include "scan/sections.h"
#include "scan/table_columns.h"
#include "volume/volume.h"

namespace hapsim {
namespace {

void take_ply_zones(const std::string& bytes, const std::string& name, Scan& scan) {
  if (bytes.substr(0, bytes.find("end_header")).find(" zone") == bytes.npos) return;
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

// The columns of the points, then those of their normals where there are all three. A name that is
// not there stands for itself in the message.
std::vector<std::string> point_columns(const CsvTable& table) {
  std::vector<std::string> names;
  for (const std::string a : {"x", "y", "z"}) {
    const std::string found = find_column(table, {a, "p" + a, "pos_" + a, "point_" + a});
    names.push_back(found.empty() ? a : found);
  }
  for (const std::string a : {"x", "y", "z"}) {
    const std::string found = find_column(table, {"n" + a, "normal_" + a, "normal" + a});
    if (!found.empty()) names.push_back(found);
  }
  if (names.size() < 6) names.resize(3);
  return names;
}

bool has_sections(const CsvTable& table, const ScanFileOptions& options) {
  return options.sections || !find_column(table, {"section", "slice"}).empty();
}

// Points and normals as they are read: of millions, the text of the cells is five times as large.
PointCloud read_numbers(CsvReader& reader, const CsvTable& head) {
  struct Column {
    std::size_t at;
    std::string name;
    BadCells bad;
  };
  std::vector<Column> columns;
  for (const std::string& name : point_columns(head)) {
    const int at = head.find(name);
    if (at < 0) fail_missing_column(head.name, name, head.header);
    columns.push_back({static_cast<std::size_t>(at), name, {}});
  }
  PointCloud cloud;
  std::vector<std::string_view> fields;
  while (reader.next(fields)) {
    double v[6] = {};
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (!parse_number(fields[columns[k].at], v[k]))
        columns[k].bad.add(columns[k].name, reader.line(), fields[columns[k].at]);
    cloud.points.emplace_back(v[0], v[1], v[2]);
    if (columns.size() == 6) cloud.normals.emplace_back(v[3], v[4], v[5]);
  }
  for (const Column& c : columns) c.bad.fail_if_any(head.name);
  return cloud;
}

Scan table_scan(const CsvTable& table, const ScanFileOptions& options) {
  if (options.robot != nullptr) return robot_scan(table, *options.robot, options.beam);
  if (has_sections(table, options))
    return sections_scan(read_sections(table, options.unit, options.section_distance));
  Scan scan;
  const std::vector<std::string> names = point_columns(table);
  scan.cloud.points = vector_columns(table, names[0], names[1], names[2]);
  if (names.size() == 6) scan.cloud.normals = vector_columns(table, names[3], names[4], names[5]);
  for (Vec3& p : scan.cloud.points) p *= options.unit;
  std::vector<int> all(table.rows());
  std::iota(all.begin(), all.end(), 0);
  take_zones(table, all, scan);
  take_touch_force(table, all, scan);
  return scan;
}

Scan read_table(std::string bytes, const std::string& name, const ScanFileOptions& options) {
  Input input = Input::from_bytes(std::move(bytes), name);
  CsvReader reader(input);
  CsvTable head;
  head.name = name;
  head.header = reader.header();
  const bool only_points = options.robot == nullptr && !has_sections(head, options) &&
                           zone_column(head).empty() && touch_force_column(head).empty();
  if (!only_points) return table_scan(read_rows(reader, name), options);
  Scan scan;
  scan.cloud = read_numbers(reader, head);
  for (Vec3& p : scan.cloud.points) p *= options.unit;
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
    scan = read_table(std::move(bytes), name, options);
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
    size = std::max(size, nth_smallest(along, along.size() - 1 - cut) - nth_smallest(along, cut));
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
