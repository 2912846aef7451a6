// What hs-import takes and gives, for --help and the man page.
#pragma once

#include <string>
#include <vector>

#include "answer.h"
#include "calibration_option.h"
#include "formats/format_table.h"
#include "hs-import/flags.h"
#include "tables/encoding.h"

namespace hapsim {

inline Option choice(const std::string& group, const AnyFlag& flag, const std::string& help,
                     const std::string& usual, const std::vector<std::string>& choices) {
  return {.flag = flag,
          .value = "HOW",
          .help = help,
          .group = group,
          .default_text = usual,
          .choices = choices};
}

inline std::string encodings() {
  std::string all;
  for (const std::string& name : known_encodings()) all += (all.empty() ? "" : ", ") + name;
  return all;
}

inline Option text(const std::string& group, const AnyFlag& flag, const std::string& value,
                   const std::string& help, const std::string& usual = "") {
  return {.flag = flag, .value = value, .help = help, .group = group, .default_text = usual};
}

inline std::vector<Option> options() {
  return {
      {.flag = flag::list,
       .help = "Prints what each column is taken for and what is missing, and converts nothing.",
       .group = "Columns"},
      {.flag = flag::column,
       .value = "ROLE=NAME",
       .help = "What a column is, where its name does not say. Roles: press, t, depth, force, "
               "temp, contact, fail, "
               "sample; x, tipx, contactx, ballx, ux, nx, fx and the same with y and z; skip.",
       .group = "Columns",
       .repeatable = true},
      {.flag = flag::names,
       .value = "NAME",
       .help = "Names of the columns of a table without a header, or instead of its header.",
       .group = "Columns",
       .repeatable = true},
      text("Columns", flag::encoding, "NAME",
           "Encoding of a text, where it is not found rightly: " + encodings() + "."),
      text("Columns", flag::part, "NAME",
           "Of a MATLAB or HDF5 file that holds several tables: the struct, group or variable that "
           "is "
           "read."),
      {.flag = flag::topic,
       .value = "NAME",
       .help = "Of a bag of ROS: the topic that is read; given twice, one of forces and one of "
               "positions. Without it the only one of each.",
       .group = "Columns",
       .repeatable = true},
      choice("Columns", flag::decimal,
             "What stands before decimals, where the table does not show it.", "auto",
             {"auto", "point", "comma"}),
      text("Columns", flag::specimen, "N",
           "Of several specimens side by side the one that is read: its number from the left. "
           "Without it all, one recording each."),
      {.flag = flag::yes,
       .help = "Goes on where a size says that a unit is wrong, or a unit is not known.",
       .group = "Columns"},
      text("Columns", flag::unit, "UNIT",
           "Unit of lengths whose name has none: m, mm, cm, um, nm, in. Without it m, or mm where "
           "the "
           "size allows nothing else (a warning)."),
      text("Columns", flag::force_unit, "UNIT",
           "Unit of forces whose name has none: N, mN, uN, nN, kN, gf, kgf, lbf. Without it N."),
      text("Columns", flag::time_unit, "UNIT",
           "Unit of a time whose name has none: s, ms, us, ns, min. Without it s."),
      text(
          "Presses", flag::split_by, "HOW",
          "How presses are told apart: names of columns (with commas), or force (where it returns "
          "to zero), jump (where the tip moves sideways), none (one press a recording). Without it "
          "all that the table offers."),
      choice("Presses", flag::contact,
             "Where a press begins: given (the table's contact point, zero of its depth), find "
             "(from the force), auto (find "
             "where the table gives none, or shows the tool in the air at depth zero).",
             "auto", {"auto", "given", "find"}),
      choice("Presses", flag::tip,
             "What a tip position is: surface (the touching point), centre (of the ball), auto "
             "(centre where it stays "
             "outside the contact points while it presses).",
             "auto", {"auto", "surface", "centre"}),
      choice("Presses", flag::force,
             "Which force is taken: the vector, its part along the normal, or its magnitude put "
             "along the normal (for "
             "vectors in the frame of a sensor that turns with the tool).",
             "vector", {"vector", "normal", "magnitude"}),
      {.flag = flag::at,
       .value = "X,Y,Z",
       .help = "Contact point of a machine that presses on one place [m]; with --block its top "
               "centre.",
       .group = "Presses"},
      text("Presses", flag::direction, "X,Y,Z", "Along which a machine's travel counts.", "0,0,-1"),
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the tool [m], written as tool_radius.",
       .group = "Tool and body"},
      {.flag = flag::tool,
       .value = "SHAPE",
       .help =
           "Shape of the tool, written as tool; platen: flat, and as wide as covers the --block.",
       .group = "Tool and body",
       .choices = {"flat", "sphere", "platen"}},
      {.flag = flag::block,
       .value = "LxWxH",
       .help = "The body is a block of this size, as 120x80x40mm, on z = 0 around x = y = 0; two "
               "lengths, as 50x30mm: a cylinder of that diameter and height.",
       .group = "Tool and body"},
      calibration_option("Tool and body"),
      {.flag = flag::surface,
       .value = "FILE",
       .help = "Writes the block as a closed surface for hs-tetmesh. Needs --block.",
       .group = "Output",
       .writes = extensions_to_write(Content::kTriangles)},
      {.flag = flag::scan,
       .value = "FILE",
       .help = "Writes the contact points (with normals where the table has them) as a scan for "
               "hs-scan2ply.",
       .group = "Output",
       .writes = kTableExtensions},
      {.flag = flag::tip_motion,
       .help = "Makes no presses: writes where the tip is in time, t,x,y,z, as hs-simulate --live "
               "follows it. Forces are not needed. Of a ball's centres (--tip centre, "
               "--tool-radius) the "
               "tip is a radius along --direction.",
       .group = "Output"},
      choice("Output", flag::estimate_noise,
             "Whether the noise of the force is estimated and written as metadata force_noise, and "
             "where it comes from as force_noise_from: from "
             "differences of neighbours "
             "and the samples in the air; auto does it where there are enough and the table says "
             "nothing.",
             "auto", {"auto", "on", "off"}),
      {.flag = flag::rate,
       .value = "HZ",
       .help = "Keeps at most so many samples a second (the noise is estimated from all).",
       .group = "Output",
       .minimum = 1e-3,
       .maximum = 1e6},
      {.flag = flag::drop_air, .help = "Leaves out the samples in the air.", .group = "Output"},
      answer_option("Output"),
  };
}

inline ToolSpec import_specification() {
  ToolSpec spec;
  spec.name = "hs-import";
  spec.task = Task::kRecording;
  spec.summary = "convert recordings of other machines and robots";
  spec.input = "table as text, in any encoding; LabVIEW .lvm, MATLAB (5, 7.3), HDF5, bag of ROS 1";
  spec.description = {
      "Columns are recognised by name, in English, German, French, Spanish, Italian, Portuguese, "
      "Chinese and Japanese, whatever their case and punctuation: "
      "\"Standardkraft [N]\", force_mN, Temps d'essai, CurrentPos_x, nx. A unit of any SI prefix "
      "in the "
      "name, or in a row of units "
      "below "
      "the header, is converted; a comment such as \"# units: mm, N\" helps where names have none. "
      "A unit "
      "that is written and not known is refused. "
      "--list shows what was understood; --column corrects it. Columns "
      "without a "
      "role are carried through and named.",
      "Separators, decimal commas, marks between thousands, titles above and statistics below the "
      "rows "
      "are found; so is the encoding (--encoding says it). Several specimens side by side (Load, "
      "Load') "
      "are all read, one recording each; the way in and the way out side by side are one press. "
      "Seconds "
      "and nanoseconds in two columns are one time; a table without a time is told by a WARNING.",
      "Lengths and forces that nothing names a unit of, and whose size makes a press, a block, a "
      "tool or a "
      "modulus "
      "(below 100 Pa, above 10 GPa) implausible, are refused with the factor that would mend them; "
      "--yes "
      "goes on.",
      "Of MATLAB and HDF5 files arrays of one length are columns, three columns x, y and z, an "
      "array of "
      "structs a recording each; what stands alone in a struct is repeated. An attribute units of "
      "a dataset "
      "names its unit.",
      "Of a bag of ROS 1 (format 2.0, not compressed) forces are a topic of "
      "geometry_msgs/WrenchStamped, "
      "positions of the tip one of PoseStamped, PointStamped or TransformStamped. Positions are "
      "taken "
      "between their stamps at those of the forces; where no position is near, the force is left "
      "out and "
      "counted. Torques and the orientation are carried through as tx,ty,tz and qw,qx,qy,qz, which "
      "--calibration reads. Torques about the sensor's origin count in hs-identify, hs-compare and "
      "hs-diagnose once the recording says where that lies from the tip, '# torque_at: X Y Z' [m].",
      "What a camera saw of marked points of the surface is a table of its own beside the "
      "recording, "
      "in its frame and by its clock (hs-identify(1), --markers).",
      "Where the table holds the centre of the tool's ball at first contact and the contact point, "
      "their "
      "distance is the ball's radius: tool: sphere and tool_radius are written, and another "
      "--tool-radius is "
      "told. A gap between the tools gives the height of the specimen, thickness [m]. A tool that "
      "slides "
      "over the surface while it presses makes no presses: motion: sliding is written, one press a "
      "recording, and --scan has every touched point. Rows marked by Fail are left out.",
      "A press needs a force (three components, or one along the normal) and one of: a "
      "displacement; tip "
      "positions, with or without a contact point; a depth or travel, with contact points and "
      "normals, or "
      "of a machine that presses on one place (--at, --direction).",
      "Where contact is not given it is found for each press: the force is fitted by b before and "
      "b + k (s - s0)^p after contact at s0, over the approach and the first 30 % of its rise, p = "
      "1, 1.25, 1.5 or 2. A press "
      "that begins in contact is extrapolated with b = 0. The approach through the air is kept: "
      "there "
      "contact is 0, and ux,uy,uz point away from the body. An offset of the force in the air is "
      "kept, for "
      "it is an effect (sensor-bias, tare).",
      "Signs are made right: the depth grows as the force does, normals point outward, and the "
      "force is "
      "that of the body on the tool. Each change is said.",
      "Rows out of order are sorted by time; rows with a missing number, a repeated time or a "
      "saturated force "
      "are left out and counted; text in place of numbers and rows of a wrong length are refused. "
      "Files "
      "with the same header may be joined by cat: each header begins a recording."};
  spec.options = options();
  spec.tables = {
      {"Output columns",
       {{"press", "number of the press: the table's if it has whole ones, else 1, 2, ..."},
        {"t", "time [s], if the table has one; clocks since 1970 begin at 0"},
        {"x, y, z", "contact point on the undeformed surface [m]"},
        {"ux, uy, uz", "displacement of the tool tip from there [m]"},
        {"fx, fy, fz", "force of the body on the tool [N]"},
        {"temp", "temperature [degC], if the table has one"},
        {"contact", "0 in the air, where force 0 is expected; absent when always 1"}}}};
  spec.examples = {
      {"hs-import liver_region1.csv --list", "What the columns are taken for."},
      {"hs-import liver_region1.csv --tool-radius 3mm --tool sphere --scan touched.csv -o data.csv",
       "A robot's probing of an organ; the touched points become its surface."},
      {"hs-import zwick.csv --block 100x100x40mm --surface block.ply --tool-radius 4mm -o data.csv",
       "A testing machine that presses on the middle of a block."},
      {"hs-import foam.csv --block 50x30mm --tool platen --surface foam.ply -o data.csv",
       "A cylinder between platens."},
      {"hs-import liver_region1.csv --calibration cal.csv --scan touched.csv -o data.csv",
       "With the sensor, the tool's weight and the arm put right (hs-calibrate(1))."},
      {"hs-import session.bag --topic /wrench --topic /tip_pose --tool-radius 4mm -o data.csv",
       "Forces and positions of a bag of ROS 1, by their stamps."},
      {"cat run*.csv | hs-import --unit mm --tool-radius 4mm -o data.csv",
       "Files joined, one recording each."}};
  spec.see_also = {"hs-scan2ply(1)", "hs-tetmesh(1)", "hs-identify(1)"};
  return spec;
}

}  // namespace hapsim
