// Other people's recordings as hapsim's: the whole way from a table to presses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "import/samples.h"
#include "recording/recording.h"
#include "rig/calibration.h"
#include "tables/raw_table.h"

namespace hapsim {

struct ImportOptions {
  std::vector<std::string> columns;  // "role=name"
  UnitChoice units;
  std::string split_by;             // "", "none", "force", "jump", or names of columns with commas
  std::optional<Vec3> at;           // contact point where the table has none [m]
  Vec3 direction = Vec3(0, 0, -1);  // along which a machine's travel counts
  std::optional<double> tool_radius;  // [m]
  std::string tool;                   // "", "flat", "sphere"
  std::string contact = "auto";       // "given", "find"
  std::string tip = "auto";           // "surface", "centre" (of a ball)
  std::string force = "vector";       // "normal", "magnitude"
  std::string noise = "auto";         // "on", "off"
  std::optional<Vec3> block;          // size of the body that is pressed [m]
  bool drop_air = false;
  std::string specimen;        // of several side by side: its number from 1; "": all
  std::optional<double> rate;  // samples a second that are kept at most [Hz]
  // Of the rig: forces are put right before anything is asked of them, displacements at the end.
  std::optional<Calibration> calibration;
};

// A touched point of the undeformed surface; normal zero when it is not known.
struct TouchedPoint {
  Vec3 point;
  Vec3 normal;
};

struct ImportResult {
  Recording recording;
  std::vector<TouchedPoint> touched;  // one a press
  Notes notes;
};

// Converts a table. Error(kBadInput) when it lacks what is needed (a force; and a depth, a tip
// position or a displacement), when no press ever touches, for bad cells, or for a
// column of --column that is absent; Error(kUsage) for a --column that cannot be meant.
ImportResult import_recording(const RawTable& table, const ImportOptions& options);

// `units`, with what comments of the table say about columns whose names say nothing: "# units: mm,
// N" or "# positions in mm". Told in `notes`.
UnitChoice units_of_comments(const RawTable& table, UnitChoice units, Notes& notes);

// What each column was taken for, and what is missing: a table for people.
std::string describe_columns(const RawTable& table, const ImportOptions& options);

}  // namespace hapsim
