// hs-scan2ply: the points of a scan, from scanners, CT and robots, cleaned, with normals.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cli/tool.h"
#include "geometry/clean_points.h"
#include "geometry/normals.h"
#include "io/number.h"
#include "scan/isosurface.h"
#include "scan/orient.h"
#include "scan/plan_file.h"
#include "scan/register.h"
#include "scan/scan_file.h"
#include "scan/touch.h"
#include "scan/volume.h"

namespace hapsim {
namespace {

constexpr const char* kTool = "hs-scan2ply";

Option number_option(const char* flag, const char* value, const char* help, double minimum,
                     double maximum, const char* default_text = "") {
  return {.flag = flag,
          .kind = OptionKind::kNumber,
          .value = value,
          .help = help,
          .default_text = default_text,
          .minimum = minimum,
          .maximum = maximum};
}
Option switch_option(const char* flag, const char* help) {
  return {.flag = flag, .kind = OptionKind::kSwitch, .help = help};
}
Option text_option(const char* flag, const char* value, const char* help,
                   const char* default_text = "") {
  return {.flag = flag, .value = value, .help = help, .default_text = default_text};
}

std::vector<Option> options() {
  return {
      {.flag = "--unit",
       .kind = OptionKind::kChoice,
       .value = "UNIT",
       .help = "Unit of coordinates, distances and sliding joints (not of volumes).",
       .default_text = "m",
       .choices = {"m", "mm", "cm", "um", "in"}},
      number_option("--spacing", "M",
                    "Thins to one point (the mean) a cubic cell of this size [m].", 1e-6, 1),
      switch_option("--keep-outliers", "Removes only points that are given twice."),
      switch_option("--ascii", "Writes an ASCII PLY."),
      {.flag = "--json",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Writes the summary, with every zone's motion, as JSON."},
      // zones
      {.flag = "--zone",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "A further zone or view of the same object.",
       .repeatable = true},
      switch_option("--register", "Moves the zones so that they agree where they overlap."),
      text_option("--fix-zone", "NAME", "Zone that stays, else the one with most overlap."),
      number_option("--most-drift", "M", "Largest drift looked for [m].", 1e-5, 1, "0.01"),
      number_option("--most-shift-error", "M", "Standard error of a shift that is accepted [m].",
                    1e-6, 1, "0.001"),
      // touch
      number_option("--touch-force", "N",
                    "Force of the touching probe, where no column touch_force says it [N].", 0,
                    100),
      number_option("--touch-stiffness", "N/M", "Undoes the indentation by this stiffness [N/m].",
                    1e-3, 1e9),
      number_option("--touch-modulus", "PA", "... or by Hertz with this modulus E [Pa].", 1, 1e13),
      number_option("--touch-nu", "NU", "Poisson's ratio with --touch-modulus.", 0, 0.5, "0.5"),
      number_option("--tip-radius", "M", "Radius of the probe's tip with --touch-modulus [m].",
                    1e-6, 1),
      switch_option("--flat-tip", "The tip is flat instead of a ball."),
      // robots
      {.flag = "--robot",
       .kind = OptionKind::kFile,
       .value = "URDF",
       .help = "The input holds joint angles of this robot."},
      text_option("--root", "LINK", "Link in whose frame points are, else the robot's first."),
      text_option("--tip", "LINK", "Link that carries the sensor, else the robot's only end."),
      text_option("--mount", "X,Y,Z[,R,P,Y]",
                  "Place [m] and roll, pitch, yaw [rad] of the sensor on the tip.", "0,0,0"),
      text_option("--beam", "X,Y,Z", "Direction of laser or bar in the sensor's frame.", "0,0,1"),
      number_option("--bar", "M",
                    "Length of a touching bar along the beam, instead of a laser [m].", 1e-6, 10),
      text_option("--object", "X,Y,Z[,R,P,Y]",
                  "Frame of the object in the robot's root, in which points are written.", "0,0,0"),
      {.flag = "--angle-unit",
       .kind = OptionKind::kChoice,
       .value = "UNIT",
       .help = "Unit of the joint angles read.",
       .default_text = "rad",
       .choices = {"rad", "deg"}},
      text_option("--range", "MIN,MAX",
                  "Distances outside [m], and cells without one, mean that nothing was seen."),
      // planning
      {.flag = "--plan",
       .kind = OptionKind::kChoice,
       .value = "WHAT",
       .help = "Writes joint angles instead: a raster over the input's surface, a level grid over "
               "--region, or one pose a row of the input.",
       .choices = {"surface", "grid", "positions"}},
      number_option("--pitch", "M", "Distance of raster points [m].", 1e-5, 1, "0.005"),
      number_option("--standoff", "M",
                    "Distance of the sensor from the surface [m], else --bar or 0.1.", 0, 10),
      text_option("--region", "X0,Y0,X1,Y1", "Plan view of the raster in the object's frame [m]."),
      number_option("--height", "Z", "Height of the grid [m].", -10, 10, "0"),
      number_option("--steepest", "DEG", "Leaves out places steeper than this.", 0, 180, "80"),
      switch_option("--check", "Exit code 1 when a pose is out of reach."),
      // CT
      number_option("--threshold", "V", "Value at a volume's surface.", -1e30, 1e30),
      switch_option("--below", "The body is where values are below the threshold."),
      switch_option("--all-parts", "Takes every part of a volume, not the largest alone."),
      switch_option("--cavities", "Takes surfaces of cavities too."),
      switch_option("--sections", "Rows of equal z are contours, in their order."),
      number_option("--section-distance", "M", "Distance of sections given without z [m].", 1e-6,
                    1),
  };
}

ToolSpec specification() {
  ToolSpec spec;
  spec.name = kTool;
  spec.summary = "clean points with normals from scans, robots and CT";
  spec.input =
      "scan: CSV, rows of numbers, PLY, STL, PCD; joint angles (--robot); sections; a "
      "volume (NRRD, NIfTI, a folder of DICOM slices)";
  spec.description = {
      "Reads the points of a surface scan by content and column name (any order, further columns "
      "are ignored), turns them into metres, removes what is not surface, gives every point an "
      "outward normal and writes a PLY of doubles for hs-reconstruct.",
      "Removed are, each counted in the summary: points equal to an earlier one; points closer "
      "than "
      "a thousandth of the usual spacing to another; isolated points, whose mean distance to their "
      "10 nearest is more than 3 times that of these neighbours (so an uneven density costs no "
      "points); points off the plane of their neighbours by more than 8 times these neighbours' "
      "own "
      "deviation (so a sharp edge keeps its points). --keep-outliers leaves the last two in.",
      "Normals, when the scan has none, are those of planes through the nearest points, as many as "
      "the noise asks for; they are turned towards the sensor where it is known, else alike along "
      "the minimum spanning tree of neighbours and then outward, away from the middle of the scan "
      "or, for a patch seen from one side, upward.",
      "Robots: with --robot the table holds joint angles q1..qN (or the joints' names) and the "
      "laser's distance d; points are the forward kinematics' sensor place plus d along the beam. "
      "With --bar they are the end of a touching bar. --plan goes the other way: joint angles that "
      "put the sensor --standoff off each place, its beam against the normal (free to turn about "
      "it); what is out of reach is named on standard error. Neither collisions nor the way "
      "between "
      "poses are checked.",
      "CT: contours of sections become points whose normals, and points between the sections, come "
      "from the signed distances of neighbouring sections (shape-based interpolation). Of a volume "
      "the points lie where values cross --threshold along voxel edges, with normals from the "
      "gradient; only the largest part that is connected across voxel faces, without cavities. "
      "Coordinates are those of the file's frame (NIfTI: right, anterior, superior; DICOM: left, "
      "posterior, superior). It takes some 6 bytes a voxel and the file unpacked.",
      "Zones: with --register the zones (a column zone, or --zone files) that drifted against each "
      "other are moved as rigid bodies, all at once, until the points of each lie on the surfaces "
      "of those it overlaps (point to plane). An overlap that is too small, or too flat to say, is "
      "refused.",
      "Touch: a probe that finds the surface by a force has pushed it in. --touch-stiffness, or "
      "--touch-modulus and --tip-radius (Hertz: depth = (3 F / (4 E* sqrt R))^(2/3), E* = E / (1 - "
      "nu^2); flat: F / (2 E* R)), move the points back out along their normals.",
      "A scan larger than 5 m or smaller than 1 mm is taken for one in another unit and refused."};
  spec.options = options();
  spec.tables = {
      {"Input columns",
       {{"x, y, z", "point, in --unit"},
        {"nx, ny, nz", "outward normal; all three or none"},
        {"zone", "name of the zone or view"},
        {"touch_force", "force that the probe pressed with [N]; its size counts"},
        {"q1, q2, ...", "with --robot: joint angles; joint1, theta1 and the joints' names do too"},
        {"d", "with --robot: distance along the beam, in --unit"},
        {"section, contour", "number of a section, name of a contour in it; x, y, z along it"}}},
      {"Output, PLY element vertex",
       {{"x, y, z", "point [m], double"}, {"nx, ny, nz", "outward unit normal, double"}}},
      {"Output with --plan",
       {{"q1, q2, ...", "joint angles [rad], or [m] of a sliding joint"},
        {"d", "distance that the sensor should read there [m]"},
        {"x, y, z, nx, ny, nz", "place [m] and outward normal in the object's frame"}}}};
  spec.examples = {
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "A body from a scan."},
      {"hs-scan2ply touched.csv --unit mm --spacing 0.001 -o points.ply",
       "Millimetres; at most one point a cubic millimetre."},
      {"hs-scan2ply coarse.ply --robot arm.urdf --plan surface --pitch 0.004 -o plan.csv",
       "Joint angles for a raster 4 mm apart."},
      {"hs-scan2ply driven.csv --robot arm.urdf --range 0.02,0.3 -o points.ply",
       "What the laser saw there."},
      {"hs-scan2ply ct.nii.gz --threshold -200 --spacing 0.002 -o points.ply",
       "The skin in a CT volume."},
      {"hs-scan2ply organ.csv --register --touch-force 0.1 --touch-stiffness 80 -o points.ply",
       "Touched zones that drifted."}};
  spec.see_also = {"hs-reconstruct(1)", "hs-tetmesh(1)"};
  return spec;
}

// Numbers between commas, as many as one of `counts`.
std::vector<double> numbers(const Arguments& arguments, const std::string& flag,
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
    fail_usage(fmt::format("{} {} holds {} numbers", flag, text, values.size()),
               fmt::format("it takes {}", fmt::join(counts, " or ")));
  }
  return values;
}

Pose pose(const Arguments& arguments, const std::string& flag) {
  std::vector<double> v = numbers(arguments, flag, {3, 6});
  v.resize(6, 0.0);
  return make_pose({v[0], v[1], v[2]}, {v[3], v[4], v[5]});
}

Beam beam_of(const Arguments& arguments) {
  Beam beam;
  beam.mount = pose(arguments, "--mount");
  beam.object = pose(arguments, "--object");
  const std::vector<double> d = numbers(arguments, "--beam", {3});
  beam.direction = Vec3(d[0], d[1], d[2]);
  if (beam.direction.norm() < 1e-9) fail_usage("--beam has no length", "write --beam 0,0,1");
  beam.direction.normalize();
  if (arguments.given("--bar")) beam.bar = arguments.number("--bar");
  beam.angle_factor = unit_factor(Quantity::kAngle, arguments.text("--angle-unit"));
  beam.length_factor = unit_factor(Quantity::kLength, arguments.text("--unit"));
  if (arguments.given("--range")) {
    const std::vector<double> r = numbers(arguments, "--range", {2});
    if (!(r[0] <= r[1])) fail_usage("--range ends before it begins", "write --range MIN,MAX");
    beam.range = {{r[0], r[1]}};
  }
  return beam;
}

Robot load_robot(const Arguments& arguments) {
  Input input(arguments.text("--robot"));
  return Robot(input.read_all(), input.name(), arguments.text("--root"), arguments.text("--tip"));
}

int run_plan(const Arguments& arguments, const ScanFileOptions& file) {
  if (file.robot == nullptr) fail_usage("--plan needs a robot", "add --robot FILE.urdf");
  const std::string what = arguments.text("--plan");
  const double pitch = arguments.number("--pitch");
  std::optional<Region> region;
  if (arguments.given("--region")) {
    const std::vector<double> r = numbers(arguments, "--region", {4});
    if (!(r[0] <= r[2] && r[1] <= r[3])) {
      fail_usage("--region ends before it begins", "write --region X0,Y0,X1,Y1");
    }
    region = {{r[0], r[1], r[2], r[3]}};
  }
  std::vector<Target> targets;
  if (what == "grid") {
    if (!region) fail_usage("--plan grid needs a region", "add --region X0,Y0,X1,Y1");
    if ((region->at(2) - region->at(0)) * (region->at(3) - region->at(1)) > 1e6 * pitch * pitch) {
      fail_usage("the grid would have more than a million places", "give a larger --pitch");
    }
    targets = raster_on_grid(*region, pitch, arguments.number("--height"));
  } else {
    Input input(arguments.input());
    const PointCloud known = what == "surface" ? read_known_surface(input, file.unit, pitch / 3)
                                               : read_positions(input, file.unit);
    check_extent(known.points, arguments.text("--unit"), input.name());
    if (what == "surface") {
      targets =
          raster_on_surface(known, pitch, region, arguments.number("--steepest") * M_PI / 180);
    } else {
      for (std::size_t i = 0; i < known.points.size(); ++i) {
        targets.push_back({known.points[i], known.normals[i]});
      }
    }
  }
  const double standoff = arguments.given("--standoff") ? arguments.number("--standoff")
                                                        : (file.beam.bar > 0 ? file.beam.bar : 0.1);
  const Plan plan = plan_scan(*file.robot, file.beam, standoff, targets);
  for (const int t : plan.unreachable) {
    const Vec3& p = targets[static_cast<std::size_t>(t)].point;
    std::fputs(
        fmt::format("{}: out of reach: {:.4f},{:.4f},{:.4f}\n", kTool, p.x(), p.y(), p.z()).c_str(),
        stderr);
  }
  if (plan.poses.empty()) {
    fail_numerics(file.robot->name(),
                  fmt::format("none of {} places can be reached", targets.size()),
                  "check --object, --tip, --mount and --region");
  }
  Output output(arguments.output());
  write_plan(output.stream(), *file.robot, targets, plan, standoff);
  output.commit();
  say(arguments, kTool,
      fmt::format("{} poses, {} of {} places out of reach; collisions were not checked",
                  plan.poses.size(), plan.unreachable.size(), targets.size()));
  return arguments.given("--check") && !plan.unreachable.empty() ? 1 : 0;
}

// A volume's surface as a scan.
Scan volume_scan(const Arguments& arguments, nlohmann::json& json) {
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
  if (!arguments.given("--threshold")) fail_no_threshold(volume, name);
  const IsoOptions options{.threshold = arguments.number("--threshold"),
                           .below = arguments.given("--below"),
                           .all_parts = arguments.given("--all-parts"),
                           .cavities = arguments.given("--cavities")};
  IsoReport report;
  Scan scan;
  scan.cloud = isosurface(volume, options, name, report);
  scan.notes = volume.notes;
  scan.notes.push_back(fmt::format(
      "{}, {} x {} x {} voxels: the body has {} ({:.1f} % of all beyond the threshold, {} parts); "
      "{:.0f} MB taken",
      volume.format, volume.size[0], volume.size[1], volume.size[2], report.voxels,
      100 * report.share, report.parts, report.memory / 1e6));
  if (report.cut > 0) {
    scan.notes.push_back(
        fmt::format("WARNING the volume's border cuts the body at {} voxels", report.cut));
  }
  json["volume"] = {{"format", volume.format},      {"size", volume.size},
                    {"body_voxels", report.voxels}, {"parts", report.parts},
                    {"cut_voxels", report.cut},     {"memory_bytes", report.memory}};
  return scan;
}

bool is_volume(const Arguments& arguments) {
  return arguments.given("--threshold") ||
         (arguments.input() != "-" && std::filesystem::is_directory(arguments.input()));
}

Scan gather(const Arguments& arguments, const ScanFileOptions& file, nlohmann::json& json,
            std::string& name) {
  if (is_volume(arguments)) {
    name = arguments.input();
    return volume_scan(arguments, json);
  }
  Input input(arguments.input());
  name = input.name();
  Scan scan = read_scan(input, file);
  for (const std::string& path : arguments.list("--zone")) {
    Input more(path);
    append_zone(scan, read_scan(more, file), std::filesystem::path(path).stem().string());
  }
  check_extent(scan.cloud.points, arguments.text("--unit"), name);
  return scan;
}

void run_register(const Arguments& arguments, Scan& scan, nlohmann::json& json,
                  const std::string& name) {
  const RegisterReport report =
      register_zones(scan,
                     {.fixed = arguments.text("--fix-zone"),
                      .most_drift = arguments.number("--most-drift"),
                      .most_error = arguments.number("--most-shift-error")},
                     name);
  for (const ZoneMotion& z : report.zones) {
    say(arguments, kTool,
        z.name == report.fixed
            ? fmt::format("zone {} stays; rms {:.3f} to {:.3f} mm in {} matches", z.name,
                          1e3 * z.rms_before, 1e3 * z.rms_after, z.overlap)
            : fmt::format(
                  "zone {} shifted by {:.3f} {:.3f} {:.3f} mm (+- {:.3f}), turned by {:.3f} "
                  "deg; rms {:.3f} to {:.3f} mm in {} matches",
                  z.name, 1e3 * z.shift.x(), 1e3 * z.shift.y(), 1e3 * z.shift.z(), 1e3 * z.error,
                  z.turn * 180 / M_PI, 1e3 * z.rms_before, 1e3 * z.rms_after, z.overlap));
    json["zones"].push_back({{"zone", z.name},
                             {"fixed", z.name == report.fixed},
                             {"points", z.points},
                             {"matches", z.overlap},
                             {"shift", {z.shift.x(), z.shift.y(), z.shift.z()}},
                             {"turn", z.turn},
                             {"shift_std_error", z.error},
                             {"rms_before", z.rms_before},
                             {"rms_after", z.rms_after}});
  }
}

// Normals of the cleaned points, turned to the sensor where the scan knows it.
std::string complete_normals(PointCloud& clean, const Scan& scan, const std::vector<int>& index) {
  if (!clean.normals.empty()) return "given";
  NormalsReport report;
  estimate_normals(clean, Vec3::UnitZ(), report);
  std::string text = fmt::format("from {} neighbours, noise about {:.2g} mm", report.neighbours,
                                 1e3 * report.noise);
  if (scan.to_sensor.empty()) return text;
  face_sensor(clean, pick(scan, index).to_sensor);
  return text + ", towards the sensor";
}

std::optional<TouchModel> touch_model(const Arguments& arguments) {
  TouchModel model;
  const bool stiffness = arguments.given("--touch-stiffness");
  const bool modulus = arguments.given("--touch-modulus");
  if (!stiffness && !modulus) {
    if (arguments.given("--touch-force")) {
      fail_usage("--touch-force alone says no indentation",
                 "add --touch-stiffness, or --touch-modulus and --tip-radius");
    }
    return {};
  }
  if (stiffness && modulus) {
    fail_usage("--touch-stiffness and --touch-modulus contradict each other", "give one of them");
  }
  if (stiffness) {
    model.stiffness = arguments.number("--touch-stiffness");
    return model;
  }
  if (!arguments.given("--tip-radius"))
    fail_usage("--touch-modulus needs the tip", "add --tip-radius");
  model.E = arguments.number("--touch-modulus");
  model.nu = arguments.number("--touch-nu");
  model.tip_radius = arguments.number("--tip-radius");
  model.flat = arguments.given("--flat-tip");
  return model;
}

// The cleaned points moved out by what the touch pushed them in.
void correct_touch(const Arguments& arguments, const TouchModel& model, const Scan& scan,
                   const std::vector<int>& index, PointCloud& clean, nlohmann::json& json,
                   const std::string& name) {
  Scan touched = pick(scan, index);
  if (touched.touch_force.empty()) {
    if (!arguments.given("--touch-force")) {
      fail_usage("the scan has no column touch_force", "add it, or give --touch-force");
    }
    touched.touch_force.assign(index.size(), arguments.number("--touch-force"));
  }
  touched.cloud = clean;
  const TouchReport report = undo_touch(touched, model, 0.05, name);
  clean = touched.cloud;
  say(arguments, kTool,
      fmt::format("indentation of the touch undone: {:.3f} mm ({:.3f} to {:.3f})",
                  1e3 * report.mean, 1e3 * report.least, 1e3 * report.largest));
  json["indentation"] = {
      {"mean", report.mean}, {"least", report.least}, {"largest", report.largest}};
}

int run(const Arguments& arguments) {
  ScanFileOptions file;
  const std::string unit = arguments.text("--unit");
  file.unit = unit_factor(Quantity::kLength, unit);
  file.sections = arguments.given("--sections");
  if (arguments.given("--section-distance")) {
    file.section_distance = arguments.number("--section-distance");
  }
  file.beam = beam_of(arguments);
  std::optional<Robot> robot;
  if (arguments.given("--robot")) file.robot = &robot.emplace(load_robot(arguments));
  if (arguments.given("--plan")) return run_plan(arguments, file);
  const std::optional<TouchModel> touch = touch_model(arguments);

  nlohmann::json json;
  std::string name;
  Scan scan = gather(arguments, file, json, name);
  for (const std::string& note : scan.notes) say(arguments, kTool, note);
  if (arguments.given("--register")) run_register(arguments, scan, json, name);

  CleanOptions options;
  options.remove_outliers = !arguments.given("--keep-outliers");
  if (arguments.given("--spacing")) options.spacing = arguments.number("--spacing");
  CleanReport removed;
  PointCloud clean = clean_points(scan.cloud, options, name, removed);
  const std::string normals = complete_normals(clean, scan, removed.index);
  if (touch) correct_touch(arguments, *touch, scan, removed.index, clean, json, name);

  const double spacing = point_spacing(clean.points);
  json["points"] = {{"read", removed.read},
                    {"duplicates", removed.duplicates},
                    {"near_duplicates", removed.near_duplicates},
                    {"isolated", removed.isolated},
                    {"off_surface", removed.off_surface},
                    {"thinned", removed.thinned},
                    {"kept", removed.kept},
                    {"spacing", spacing},
                    {"normals", normals}};
  if (arguments.given("--json")) {
    Output report(arguments.text("--json"));
    report.write(json.dump(2) + "\n");
    report.commit();
  }
  Output output(arguments.output());
  write_points_ply(output.stream(), clean, arguments.given("--ascii"),
                   {"hs-scan2ply: points in m, read in " + unit});
  output.commit();
  say(arguments, kTool,
      fmt::format("{} points read in {}; removed {} given twice, {} nearly so, {} isolated, {} off "
                  "the surface, {} by thinning; kept {}, {:.3g} mm apart; normals {}",
                  removed.read, is_volume(arguments) ? "the volume's frame" : unit,
                  removed.duplicates, removed.near_duplicates, removed.isolated,
                  removed.off_surface, removed.thinned, removed.kept, 1e3 * spacing, normals));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
