#include "import/tip_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/error.h"
#include "import/column_roles.h"
#include "io/csv.h"

namespace hapsim {
namespace {

// A unit that the columns name wins over --unit, which must not go unheard.
void refuse_other_unit(const RawTable& table, const UnitName& named, const std::string& told) {
  if (told.empty() || named.kind != UnitKind::kLength) return;
  const UnitName wanted = parse_unit(told);
  if (wanted.kind == UnitKind::kLength && wanted.factor != named.factor)
    fail_input(table.name, "the positions are in " + named.name + " by their columns, not " + told,
               "leave out --unit, or name the columns by --names");
}

// As of recordings and of what hs-simulate takes, and as the size by which a unit is guessed.
void check_size(const std::string& name, bool trusted, TipMotion& motion) {
  constexpr double kFarthest = 10, kWidest = 1.5;  // [m]
  Vec3 low = motion.tip.front(), high = low;
  for (const Vec3& tip : motion.tip) low = low.cwiseMin(tip), high = high.cwiseMax(tip);
  const double away = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  const double width = (high - low).maxCoeff();
  if (away <= kFarthest && width <= kWidest) return;
  const std::string wrong = away > kFarthest
                                ? fmt::format("a position of the tip is {:.3g} m away", away)
                                : fmt::format("the tip moves over {:.3g} m", width);
  const std::string mend =
      "in millimetres it is 1000 times less: say --unit mm, or put the unit of the columns right";
  if (!trusted) fail_input(name, wrong, mend + ", or --yes where it is right");
  motion.notes.warnings.push_back(wrong + ": " + mend);
}

}  // namespace

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
  const std::array<int, 3>& columns = *map.find(role);
  if (*std::min_element(columns.begin(), columns.end()) < 0)
    fail_input(table.name, "the positions of the tip have not all of x, y and z",
               "see --list; --column tipz=NAME says which column is z");
  refuse_other_unit(table, map.unit[static_cast<std::size_t>(columns[0])], options.units.length);
  const Samples samples = load_samples(
      table, map, units_of_comments(table, options.units, motion.notes), 0, motion.notes);
  std::vector<int> rows = samples.usable;
  if (rows.empty()) fail_input(table.name, "no row can be used", "see --list");
  const std::vector<double>& t = samples[ScalarRole::kTime];
  std::stable_sort(rows.begin(), rows.end(), [&t](int a, int b) { return t[at(a)] < t[at(b)]; });
  for (const int row : rows) {
    motion.t.push_back(t[at(row)]);
    motion.tip.push_back(samples[role][at(row)]);
  }
  check_size(table.name, options.units.trusted, motion);
  if (options.tip == "centre") {
    const double radius = options.tool_radius.value();
    const Vec3 along = options.direction.normalized();
    for (Vec3& tip : motion.tip) tip += radius * along;
    motion.notes.facts.push_back(fmt::format(
        "positions of the ball's centre: the tip is {:.3g} mm from it along {:.3g},{:.3g},{:.3g} "
        "(--direction)",
        1e3 * radius, along.x(), along.y(), along.z()));
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
