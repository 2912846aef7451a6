// hs-scan2ply: the points of a scan, from scanners, CT and robots, cleaned, with normals.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/shell_words.h"
#include "base/units.h"
#include "cli/tell.h"
#include "formats/format_table.h"
#include "hs-scan2ply/flags.h"
#include "hs-scan2ply/specification.h"
#include "io/extension.h"
#include "io/number.h"
#include "scan/plan_file.h"
#include "scan/scan_file.h"
#include "scan/scan_record.h"
#include "volume/volume.h"

namespace hapsim {
namespace {

// Numbers between commas, as many as one of `counts`.
std::vector<double> numbers(const Arguments& arguments, const AnyFlag& flag,
                            const std::vector<std::size_t>& counts) {
  const std::string text = arguments.text(flag);
  std::vector<double> values;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    double value = 0;
    if (!parse_number(text.substr(from, to - from), value)) {
      fail_usage(flag + " " + text + " holds what is no number", "see --help for its form");
    }
    values.push_back(value);
    from = to + 1;
  }
  if (std::find(counts.begin(), counts.end(), values.size()) == counts.end()) {
    fail_usage(fmt::format("{} {} holds {} numbers", flag.name, text, values.size()),
               fmt::format("it takes {}", fmt::join(counts, " or ")));
  }
  return values;
}

Pose pose(const Arguments& arguments, const AnyFlag& flag) {
  std::vector<double> v = numbers(arguments, flag, {3, 6});
  v.resize(6, 0.0);
  return make_pose({v[0], v[1], v[2]}, {v[3], v[4], v[5]});
}

Beam beam_of(const Arguments& arguments) {
  Beam beam;
  beam.mount = pose(arguments, flag::mount);
  beam.object = pose(arguments, flag::object);
  const std::vector<double> d = numbers(arguments, flag::beam, {3});
  beam.direction = Vec3(d[0], d[1], d[2]);
  if (beam.direction.norm() < 1e-9) fail_usage("--beam has no length", "write --beam 0,0,1");
  beam.direction.normalize();
  if (arguments.given(flag::bar)) beam.bar = arguments[flag::bar];
  beam.angle_factor = unit_factor(Quantity::kAngle, arguments[flag::angle_unit]);
  beam.length_factor = unit_factor(Quantity::kLength, arguments[flag::unit]);
  if (arguments.given(flag::range)) {
    const std::vector<double> r = numbers(arguments, flag::range, {2});
    if (!(r[0] <= r[1])) fail_usage("--range ends before it begins", "write --range MIN,MAX");
    beam.range = {{r[0], r[1]}};
  }
  return beam;
}

Robot load_robot(const Arguments& arguments) {
  Input input(arguments[flag::robot]);
  return Robot(input.read_all(), input.name(), arguments[flag::root], arguments[flag::tip]);
}

int run_plan(const Arguments& arguments, const ScanFileOptions& file) {
  if (file.robot == nullptr) fail_usage("--scan-plan needs a robot", "add --robot FILE.urdf");
  const std::string what = arguments[flag::plan];
  const double pitch = arguments[flag::pitch];
  std::optional<Region> region;
  if (arguments.given(flag::region)) {
    const std::vector<double> r = numbers(arguments, flag::region, {4});
    if (!(r[0] <= r[2] && r[1] <= r[3])) {
      fail_usage("--area ends before it begins", "write --area X0,Y0,X1,Y1");
    }
    region = {{r[0], r[1], r[2], r[3]}};
  }
  std::vector<Target> targets;
  if (what == "grid") {
    if (!region) fail_usage("--scan-plan grid needs a region", "add --area X0,Y0,X1,Y1");
    if ((region->at(2) - region->at(0)) * (region->at(3) - region->at(1)) > 1e6 * pitch * pitch) {
      fail_usage("the grid would have more than a million places", "give a larger --pitch");
    }
    targets = raster_on_grid(*region, pitch, arguments[flag::height]);
  } else {
    Input input(arguments.input());
    const PointCloud known = what == "surface" ? read_known_surface(input, file.unit, pitch / 3)
                                               : read_positions(input, file.unit);
    check_extent(known.points, arguments[flag::unit], input.name());
    if (what == "surface") {
      targets = raster_on_surface(known, pitch, region, arguments[flag::steepest] * M_PI / 180);
    } else {
      for (std::size_t i = 0; i < known.points.size(); ++i) {
        targets.push_back({known.points[i], known.normals[i]});
      }
    }
  }
  const double standoff = arguments.given(flag::standoff)
                              ? arguments[flag::standoff]
                              : (file.beam.bar > 0 ? file.beam.bar : 0.1);
  const ScanPlan plan = plan_scan(*file.robot, file.beam, standoff, targets);
  for (const int t : plan.unreachable) {
    const Vec3& p = targets[static_cast<std::size_t>(t)].point;
    std::fputs(
        fmt::format("{}: out of reach: {:.4f},{:.4f},{:.4f}\n", kTool, p.x(), p.y(), p.z()).c_str(),
        stderr);
  }
  if (plan.poses.empty()) {
    fail_numerics(file.robot->name(),
                  fmt::format("none of {} places can be reached", targets.size()),
                  "check --object-frame, --tip-link, --mount and --area");
  }
  Output output(result_file(arguments));
  write_plan(output.stream(), *file.robot, targets, plan, standoff);
  output.commit();
  say(arguments, kTool,
      fmt::format("{} poses, {} of {} places out of reach; collisions were not checked",
                  plan.poses.size(), plan.unreachable.size(), targets.size()));
  return arguments[flag::check] && !plan.unreachable.empty() ? 1 : 0;
}

// A volume's surface as a scan.
Scan volume_scan(const Arguments& arguments, ScanRecord& record) {
  const std::string path = arguments.input();
  const bool folder = path != "-" && std::filesystem::is_directory(path);
  Volume volume;
  std::string name = path;
  if (folder) {
    volume = read_dicom_series(path);
  } else {
    Input input(path);
    name = input.name();
    volume = read_volume(input.read_all(), name);
  }
  if (!arguments.given(flag::threshold)) fail_no_threshold(volume, name);
  const IsoOptions options{.threshold = arguments[flag::threshold],
                           .below = arguments[flag::below],
                           .all_parts = arguments[flag::all_parts],
                           .cavities = arguments[flag::cavities]};
  return scan_of_volume(volume, options, name, record);
}

bool is_volume(const Arguments& arguments) {
  return arguments.given(flag::threshold) ||
         (arguments.input() != "-" && std::filesystem::is_directory(arguments.input()));
}

Scan gather(const Arguments& arguments, const ScanFileOptions& file, ScanRecord& record,
            std::string& name) {
  if (is_volume(arguments)) {
    name = arguments.input();
    return volume_scan(arguments, record);
  }
  Input input(arguments.input());
  name = input.name();
  Scan scan = read_scan(input, file);
  for (const std::string& path : arguments.list(flag::zone)) {
    Input more(path);
    append_zone(scan, read_scan(more, file), std::filesystem::path(path).stem().string());
  }
  check_extent(scan.cloud.points, arguments[flag::unit], name);
  return scan;
}

void run_register(const Arguments& arguments, Scan& scan, ScanRecord& record,
                  const std::string& name) {
  record.registered = register_zones(scan,
                                     {.fixed = arguments[flag::fix_zone],
                                      .most_drift = arguments[flag::most_drift],
                                      .most_error = arguments[flag::most_shift_error]},
                                     name);
  for (const std::string& line : zone_lines(*record.registered)) say(arguments, kTool, line);
}

std::optional<TouchModel> touch_model(const Arguments& arguments) {
  TouchModel model;
  const bool stiffness = arguments.given(flag::touch_stiffness);
  const bool modulus = arguments.given(flag::touch_modulus);
  if (!stiffness && !modulus) {
    if (arguments.given(flag::touch_force)) {
      fail_usage("--touch-force alone says no indentation",
                 "add --touch-stiffness, or --touch-modulus and --tip-radius");
    }
    return {};
  }
  if (stiffness && modulus) {
    fail_usage("--touch-stiffness and --touch-modulus contradict each other", "give one of them");
  }
  if (stiffness) {
    model.stiffness = arguments[flag::touch_stiffness];
    return model;
  }
  if (!arguments.given(flag::tip_radius))
    fail_usage("--touch-modulus needs the tip", "add --tip-radius");
  model.E = arguments[flag::touch_modulus];
  model.nu = arguments[flag::touch_nu];
  model.tip_radius = arguments[flag::tip_radius];
  model.flat = arguments[flag::flat_tip];
  return model;
}

// The cleaned points moved out by what the touch pushed them in.
void correct_touch(const Arguments& arguments, const TouchModel& model, const Scan& scan,
                   const std::vector<int>& index, PointCloud& clean, ScanRecord& record,
                   const std::string& name) {
  Scan touched = pick(scan, index);
  if (touched.touch_force.empty()) {
    if (!arguments.given(flag::touch_force)) {
      fail_input(name, "the scan has no column touch_force", "add it, or give --touch-force");
    }
    touched.touch_force.assign(index.size(), arguments[flag::touch_force]);
  }
  touched.cloud = clean;
  record.touch = undo_touch(touched, model, 0.05, name);
  clean = touched.cloud;
  say(arguments, kTool, touch_words(*record.touch));
}

int run(const Arguments& arguments) {
  const std::string end = extension_of(arguments.output());
  if (arguments.given(flag::plan) && !end.empty() && end != "csv" && end != "txt")
    fail_usage("--output ends in ." + end + ", and a plan is a table", "end it in .csv");
  ScanFileOptions file;
  const std::string unit = arguments[flag::unit];
  file.unit = unit_factor(Quantity::kLength, unit);
  file.sections = arguments[flag::sections];
  if (arguments.given(flag::section_distance)) {
    file.section_distance = arguments[flag::section_distance];
  }
  file.beam = beam_of(arguments);
  std::optional<Robot> robot;
  if (arguments.given(flag::robot)) file.robot = &robot.emplace(load_robot(arguments));
  if (arguments.given(flag::plan)) return run_plan(arguments, file);
  const std::optional<TouchModel> touch = touch_model(arguments);

  ScanRecord record;
  std::string name;
  Scan scan = gather(arguments, file, record, name);
  for (const std::string& note : scan.notes) say(arguments, kTool, note);
  if (arguments[flag::register_]) run_register(arguments, scan, record, name);

  CleanOptions options;
  options.remove_outliers = !arguments[flag::keep_outliers];
  if (arguments.given(flag::spacing)) options.spacing = arguments[flag::spacing];
  PointCloud clean = clean_points(scan.cloud, options, name, record.cleaned);
  record.normals = complete_normals(clean, scan, record.cleaned.index);
  if (touch) correct_touch(arguments, *touch, scan, record.cleaned.index, clean, record, name);

  record.spacing = point_spacing(clean.points);
  if (arguments.given(flag::json)) {
    Output report(arguments[flag::json]);
    report.write(scan_json(record));
    report.commit();
  }
  Output output(result_file(arguments));
  format_to_write(arguments.output(), Content::kPoints)
      .write_points(output.stream(), clean,
                    {.ascii = arguments[flag::ascii],
                     .comments = {"hs-scan2ply: points in m, read in " + unit}});
  output.commit();
  Summary summary = points_summary(record, record.volume ? "the volume's frame" : unit);
  if (arguments.output() != "-")
    summary.next = "hs-reconstruct " + shell_quoted(arguments.output()) + " -o surface.ply";
  say_summary(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::scan2ply_specification(), argc, argv, hapsim::run);
}
