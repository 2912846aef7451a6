#include "import/import.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "import/assemble.h"
#include "import/calibrated_samples.h"
#include "import/column_roles.h"
#include "import/implausible.h"
#include "import/press_track.h"
#include "import/side_by_side.h"
#include "tables/column_name.h"

namespace hapsim {
namespace {

bool is_mode(const std::string& split_by) {
  return split_by.empty() || split_by == "none" || split_by == "force" || split_by == "jump";
}

// The roles that were told, with the columns of --split-by as names of presses.
std::vector<std::string> told_columns(const ImportOptions& options) {
  std::vector<std::string> told = options.columns;
  if (is_mode(options.split_by)) return told;
  for (std::size_t from = 0; from <= options.split_by.size();) {
    const std::size_t to = std::min(options.split_by.find(',', from), options.split_by.size());
    told.push_back("press=" + options.split_by.substr(from, to - from));
    from = to + 1;
  }
  return told;
}

// Curves side by side below each other, unless it is told which columns are meant.
RawTable curves_of(const RawTable& table, const ImportOptions& options) {
  const bool told =
      std::any_of(options.columns.begin(), options.columns.end(), [](const auto& text) {
        return text.rfind("force=", 0) == 0 || text.rfind("depth=", 0) == 0;
      });
  return told ? table : unfold(table, options.specimen);
}

// What was in the table and had no part in the recording.
void note_unused(const RawTable& table, const ColumnMap& map, Notes& notes) {
  std::string all;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    if (map.meaning[c].empty()) all += (all.empty() ? "" : ", ") + table.header[c];
  if (!all.empty()) notes.facts.push_back("not used, carried through: " + all);
}

// Presses cut out of one recording follow each other without time to recover.
void note_recovery(const std::vector<PressTrack>& tracks, const Samples& samples,
                   ImportResult& result) {
  const auto& t = samples[ScalarRole::kTime];
  if (t.empty()) return;
  for (std::size_t p = 1; p < tracks.size(); ++p) {
    const PressTrack &before = tracks[p - 1], &now = tracks[p];
    if (before.segment.recording != now.segment.recording) continue;
    if ((before.contact - now.contact).norm() > 1e-3) continue;
    result.recording.metadata.set("recovery", "none");
    result.notes.facts.push_back(
        "presses at one place follow each other in one recording: recovery none");
    return;
  }
}

// A time that is the same for all of a site says when it was visited: the presses are quasi-static.
void drop_standing_time(Samples& samples, Notes& notes) {
  auto& t = samples.scalars[static_cast<std::size_t>(ScalarRole::kTime)];
  if (t.empty() || samples.usable.size() < 3) return;
  std::size_t same = 0;
  for (std::size_t i = 1; i < samples.usable.size(); ++i)
    same += t[static_cast<std::size_t>(samples.usable[i])] ==
            t[static_cast<std::size_t>(samples.usable[i - 1])];
  if (2 * same < samples.usable.size()) return;
  t.clear();
  notes.warnings.push_back(
      "most rows repeat the time of the row before: it is left out, the presses are quasi-static");
}

}  // namespace

UnitChoice units_of_comments(const RawTable& table, UnitChoice units, Notes& notes) {
  for (const Metadata::Line& line : table.metadata.lines()) {
    const std::vector<std::string> words = take_apart(line.key + " " + line.value + " .").words;
    const auto any = [&words](std::initializer_list<const char*> wanted) {
      return std::any_of(words.begin(), words.end(), [&wanted](const std::string& word) {
        return std::find(wanted.begin(), wanted.end(), word) != wanted.end();
      });
    };
    const bool lengths = any({"unit", "units", "position", "positions", "length", "lengths",
                              "coordinates", "depth", "points"});
    if (!units.length.empty() || !lengths || !any({"mm", "millimetres", "millimeters"})) continue;
    units.length = "mm";
    notes.facts.push_back("a comment says that lengths are in mm");
  }
  return units;
}

ImportResult import_recording(const RawTable& given, const ImportOptions& options) {
  const RawTable table = curves_of(given, options);
  ImportResult result;
  result.notes.facts = table.notes;
  const ColumnMap map = recognise_columns(table, told_columns(options));
  const double height = options.at ? options.at->z() : 0;
  const UnitChoice units = units_of_comments(table, options.units, result.notes);
  Samples samples = load_samples(table, map, units, height, result.notes);
  if (samples.usable.empty()) fail_input(table.name, "no row can be used", "see --list");
  drop_standing_time(samples, result.notes);
  if (options.calibration) calibrate_samples(table, *options.calibration, samples, result.notes);
  const TrackPlan plan = plan_tracks(samples, map, table.name);
  std::vector<PressTrack> tracks =
      make_tracks(samples, plan,
                  find_segments(samples, is_mode(options.split_by) ? options.split_by : "",
                                table.name, result.notes),
                  options, result.notes);
  place_contacts(tracks, plan, options, map.displacement_word, result.notes);
  if (tracks.empty())
    fail_input(table.name, "no press ever touches: the force stays within its noise",
               "see --list for what was taken for the force");
  if (!plan.contact && !plan.tip && !options.at)
    result.notes.facts.push_back(
        "the table has no positions: contact at 0,0,0 (--at or --block say where)");
  note_unused(table, map, result.notes);
  if (!map.has(ScalarRole::kTime))
    result.notes.warnings.push_back(
        "no column is a time: the presses are quasi-static, and nothing that acts in time can be "
        "told "
        "(--column t=NAME)");
  assemble(table, map, samples, options, tracks, result);
  if (options.calibration) calibrate_displacements(*options.calibration, result.recording);
  check_plausible(result.recording, samples, options, result.notes);
  note_recovery(tracks, samples, result);
  return result;
}

std::string describe_columns(const RawTable& given, const ImportOptions& options) {
  const RawTable table = curves_of(given, options);
  const ColumnMap map = recognise_columns(table, told_columns(options));
  std::string text = fmt::format("{:<28} {:<8} {}\n", "column", "unit", "taken for");
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const bool role = !map.meaning[c].empty();
    text += fmt::format("{:<28} {:<8} {}\n", table.header[c],
                        role && !map.unit[c].name.empty() ? map.unit[c].name : "",
                        role ? map.meaning[c] : "(not used, carried through)");
  }
  const auto miss = [&text](bool missing, const std::string& what) {
    if (missing) text += "missing: " + what + "\n";
  };
  miss(!map.has(VectorRole::kForce) && !map.has(ScalarRole::kForce),
       "a force (--column force=NAME)");
  const bool place = map.has(VectorRole::kDisplacement) || map.has(VectorRole::kTip) ||
                     map.has(VectorRole::kPlain) || map.has(VectorRole::kDeformed) ||
                     map.has(VectorRole::kDesired) || map.has(ScalarRole::kDepth);
  miss(!place, "a depth, tip position or displacement (--column depth=NAME)");
  miss(!map.has(ScalarRole::kTime), "a time: the presses will be quasi-static");
  miss(map.press.empty(),
       "a column that names the press: presses are told apart by their values (--split-by)");
  miss(!map.has(VectorRole::kPlain) && !map.has(VectorRole::kContact) &&
           !map.has(VectorRole::kContactBall) && !map.has(VectorRole::kTip),
       "positions: --at or --block say where contact is");
  return text;
}

}  // namespace hapsim
