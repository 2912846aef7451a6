// The command line of hs-scan2ply: options, columns, examples.
#pragma once

#include <vector>

#include "cli/tool.h"
#include "formats/format_table.h"
#include "hs-scan2ply/flags.h"

namespace hapsim {

inline constexpr const char* kTool = "hs-scan2ply";

inline Option number_option(const AnyFlag& flag, const char* value, const char* help,
                            double minimum, double maximum, const char* default_text = "") {
  return {.flag = flag,
          .value = value,
          .help = help,
          .default_text = default_text,
          .minimum = minimum,
          .maximum = maximum};
}
inline Option switch_option(const AnyFlag& flag, const char* help) {
  return {.flag = flag, .help = help};
}
inline Option text_option(const AnyFlag& flag, const char* value, const char* help,
                          const char* default_text = "") {
  return {.flag = flag, .value = value, .help = help, .default_text = default_text};
}

inline std::vector<Option> scan2ply_options() {
  std::vector<Option> all;
  const auto add = [&all](const char* group, const std::vector<Option>& options) {
    for (Option option : options) {
      option.group = group;
      all.push_back(std::move(option));
    }
  };
  add("Points",
      {{.flag = flag::unit,
        .value = "UNIT",
        .help = "Unit of coordinates, distances and sliding joints (not of volumes).",
        .default_text = "m",
        .choices = {"m", "mm", "cm", "um", "in"}},
       number_option(
           flag::spacing, "M",
           "Thins to points about so far apart, each the mean of those about it [m]; else "
           "as described above, and with 1um not at all.",
           1e-6, 1),
       switch_option(flag::keep_outliers, "Removes only points that are given twice."),
       switch_option(flag::ascii, "Writes text instead of a binary PLY."),
       {.flag = flag::json,
        .value = "FILE",
        .help = "Writes the summary, with every zone's motion, as JSON.",
        .writes = {"json"}}});
  add("Zones",
      {{.flag = flag::zone,
        .value = "FILE",
        .help = "A further zone or view of the same object.",
        .repeatable = true},
       switch_option(flag::register_, "Moves the zones so that they agree where they overlap."),
       text_option(flag::fix_zone, "NAME", "Zone that stays, else the one with most overlap."),
       number_option(flag::most_drift, "M", "Largest drift looked for [m].", 1e-5, 1, "0.01"),
       number_option(flag::most_shift_error, "M", "Standard error of a shift that is accepted [m].",
                     1e-6, 1, "0.001")});
  add("Touch",
      {number_option(flag::touch_force, "N",
                     "Force of the touching probe, where no column touch_force says it [N].", 0,
                     100),
       number_option(flag::touch_stiffness, "N/M",
                     "Undoes the indentation by this stiffness [N/m].", 1e-3, 1e9),
       number_option(flag::touch_modulus, "PA", "... or by Hertz with this modulus E [Pa].", 1,
                     1e13),
       number_option(flag::touch_nu, "NU", "Poisson's ratio with --touch-modulus.", 0, 0.5, "0.5"),
       number_option(flag::tip_radius, "M", "Radius of the probe's tip with --touch-modulus [m].",
                     1e-6, 1),
       switch_option(flag::flat_tip, "The tip is flat instead of a ball.")});
  add("Robot",
      {{.flag = flag::robot,
        .value = "URDF",
        .help = "The input holds joint angles of this robot."},
       text_option(flag::root, "LINK", "Link in whose frame points are, else the robot's first."),
       text_option(flag::tip, "LINK", "Link that carries the sensor, else the robot's only end."),
       text_option(flag::mount, "X,Y,Z[,R,P,Y]",
                   "Place [m] and roll, pitch, yaw [rad] of the sensor on the tip.", "0,0,0"),
       text_option(flag::beam, "X,Y,Z", "Direction of laser or bar in the sensor's frame.",
                   "0,0,1"),
       number_option(flag::bar, "M",
                     "Length of a touching bar along the beam, instead of a laser [m].", 1e-6, 10),
       text_option(flag::object, "X,Y,Z[,R,P,Y]",
                   "Frame of the object in the robot's root, in which points are written.",
                   "0,0,0"),
       {.flag = flag::angle_unit,
        .value = "UNIT",
        .help = "Unit of the joint angles read.",
        .default_text = "rad",
        .choices = {"rad", "deg"}},
       text_option(flag::range, "MIN,MAX",
                   "Distances outside [m], and cells without one, mean that nothing was seen.")});
  add("Plan",
      {{.flag = flag::plan,
        .value = "WHAT",
        .help = "Writes joint angles instead: a raster over the input's surface, a level grid over "
                "--area, or one pose a row of the input.",
        .choices = {"surface", "grid", "positions"}},
       number_option(flag::pitch, "M", "Distance of raster points [m].", 1e-5, 1, "0.005"),
       number_option(flag::standoff, "M",
                     "Distance of the sensor from the surface [m], else --bar or 0.1.", 0, 10),
       text_option(flag::region, "X0,Y0,X1,Y1",
                   "Plan view of the raster in the object's frame [m]."),
       number_option(flag::height, "Z", "Height of the grid [m].", -10, 10, "0"),
       number_option(flag::steepest, "DEG", "Leaves out places steeper than this.", 0, 180, "80"),
       switch_option(flag::check, "Exit code 1 when a pose is out of reach.")});
  add("Volume",
      {number_option(flag::threshold, "V", "Value at a volume's surface.", -1e30, 1e30),
       switch_option(flag::below, "The body is where values are below the threshold."),
       switch_option(flag::all_parts, "Takes every part of a volume, not the largest alone."),
       switch_option(flag::cavities, "Takes surfaces of cavities too."),
       switch_option(flag::sections, "Rows of equal z are contours, in their order."),
       number_option(flag::section_distance, "M", "Distance of sections given without z [m].", 1e-6,
                     1)});
  return all;
}

inline ToolSpec scan2ply_specification() {
  ToolSpec spec;
  spec.name = kTool;
  spec.task = Task::kBody;
  spec.summary = "clean points with normals from scans, robots and CT";
  spec.input = "scan: " + names_to_read(Content::kPoints) +
               " (rows of numbers); joint angles (--robot); sections; a "
               "volume (NRRD, NIfTI, a folder of DICOM slices)";
  spec.description = {
      "Reads the points of a surface scan by content and column name (any order, further columns "
      "are ignored), turns them into metres, removes what is not surface, gives every point an "
      "outward normal and writes a PLY of doubles for hs-reconstruct.",
      "Scans denser than their surface asks for are thinned first, to 50,000 to 100,000 points, or "
      "fewer where these would lie closer than five times the noise, which the planes of "
      "neighbours "
      "could not tell apart; only where that leaves less than two thirds of them. Each point that "
      "is "
      "kept is the mean of a part of the surface as wide as their spacing and as deep as the "
      "noise, "
      "which falls by the square root of the points merged; the mean lies spacing^2 / (12 R) "
      "inside "
      "a surface of radius R. Points of few, where others are of 5 times as many, go when they "
      "lie "
      "in no surface. The summary says how many became how many, how far apart, and why. --spacing "
      "sets it.",
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
      "With --bar they are the end of a touching bar. --scan-plan goes the other way: joint angles "
      "that "
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
  spec.options = scan2ply_options();
  spec.writes = extensions_to_write(Content::kPoints);
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
      {"Output with --scan-plan",
       {{"q1, q2, ...", "joint angles [rad], or [m] of a sliding joint"},
        {"d", "distance that the sensor should read there [m]"},
        {"x, y, z, nx, ny, nz", "place [m] and outward normal in the object's frame"}}}};
  spec.examples = {
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "A body from a scan."},
      {"hs-scan2ply touched.csv --unit mm --spacing 0.001 -o points.ply",
       "Millimetres; points a millimetre apart."},
      {"hs-scan2ply coarse.ply --robot arm.urdf --scan-plan surface --pitch 0.004 -o plan.csv",
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

}  // namespace hapsim
