#include "import/tip_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.h"
#include "base/error.h"
#include "import/column_roles.h"
#include "io/csv.h"

namespace hapsim {

TipMotion tip_motion(const RawTable& table, const ImportOptions& options) {
  TipMotion motion;
  motion.notes.facts = table.notes;
  const ColumnMap map = recognise_columns(table, options.columns);
  const VectorRole role = map.has(VectorRole::kTip) ? VectorRole::kTip : VectorRole::kPlain;
  if (!map.has(role))
    fail_input(table.name, "no columns are positions of the tip",
               "see --list; --column tipx=NAME, and y, z, say which they are");
  if (!map.has(ScalarRole::kTime))
    fail_input(table.name, "no column is a time", "--column t=NAME says which it is");
  const Samples samples =
      load_samples(table, map, options.units, options.at ? options.at->z() : 0, motion.notes);
  std::vector<int> rows = samples.usable;
  if (rows.empty()) fail_input(table.name, "no row can be used", "see --list");
  const std::vector<double>& t = samples[ScalarRole::kTime];
  std::stable_sort(rows.begin(), rows.end(), [&t](int a, int b) { return t[at(a)] < t[at(b)]; });
  for (const int row : rows) {
    motion.t.push_back(t[at(row)]);
    motion.tip.push_back(samples[role][at(row)]);
  }
  motion.metadata.set("source", table.name);
  if (options.tool_radius) motion.metadata.set("tool_radius", format_number(*options.tool_radius));
  if (!options.tool.empty()) motion.metadata.set("tool", options.tool);
  return motion;
}

void write_tip_motion(std::ostream& out, const TipMotion& motion) {
  CsvWriter writer(out, motion.metadata, {"t", "x", "y", "z"});
  for (std::size_t i = 0; i < motion.t.size(); ++i)
    writer.row({format_number(motion.t[i]), format_number(motion.tip[i].x()),
                format_number(motion.tip[i].y()), format_number(motion.tip[i].z())});
}

Summary tip_motion_summary(const TipMotion& motion) {
  Summary s;
  const double length = motion.t.back() - motion.t.front();
  s.verdict = counted(static_cast<std::ptrdiff_t>(motion.t.size()), "position", "positions") +
              " of the tip";
  s.size = fmt::format("{:.4g} s", length);
  for (const std::string& warning : motion.notes.warnings) s.notes.push_back("WARNING: " + warning);
  s.mark = s.notes.empty() ? Summary::Mark::kGood : Summary::Mark::kOpen;
  if (!motion.notes.facts.empty()) s.items.push_back({"READ", "", "", motion.notes.facts});
  s.values = {{"positions", static_cast<double>(motion.t.size()), "1"}, {"time", length, "s"}};
  return s;
}

}  // namespace hapsim
