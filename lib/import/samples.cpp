#include "import/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "io/csv.h"
#include "io/number.h"
#include "tables/raw_rows.h"

namespace hapsim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// "2024-05-01" or "01.05.2024" as days since 1970 (Hinnant, "chrono-Compatible Low-Level Date
// Algorithms", days_from_civil); false when it is no date.
bool parse_date(std::string_view text, double& days) {
  std::array<int, 3> part{};
  std::size_t count = 0, digits = 0, first_digits = 0;
  for (const char c : text) {
    if (c >= '0' && c <= '9') {
      part[count] = 10 * part[count] + (c - '0');
      if (++digits > 4) return false;
    } else if (std::string_view("-/.").find(c) != std::string_view::npos && digits > 0 &&
               count < 2) {
      if (count++ == 0) first_digits = digits;
      digits = 0;
    } else {
      return false;
    }
  }
  if (count != 2 || digits == 0) return false;
  const bool year_first = first_digits == 4;
  const int y0 = year_first ? part[0] : part[2], m = part[1], d = year_first ? part[2] : part[0];
  const int y = y0 - (m <= 2), era = y / 400, of_era = y - 400 * era;
  const int of_year = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  days = era * 146097.0 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
  return true;
}

// "12:03:01.25" as seconds; a date may stand before it.
bool parse_clock(std::string_view text, double& seconds) {
  seconds = 0;
  if (const std::size_t gap = text.find_first_of(" T"); gap != text.npos) {
    double days, rest;
    if (!parse_date(text.substr(0, gap), days) || !parse_clock(text.substr(gap + 1), rest))
      return false;
    seconds = 86400 * days + rest;
    return true;
  }
  std::size_t parts = 0;
  for (std::string_view rest = text; parts < 3; ++parts) {
    const std::size_t colon = rest.find(':');
    double part;
    if (!parse_number(rest.substr(0, colon), part)) return false;
    seconds = 60 * seconds + part;
    if (colon == rest.npos) return parts >= 1;
    rest.remove_prefix(colon + 1);
  }
  return false;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  void add(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high >= low ? high - low : 0; }
  double largest() const { return high >= low ? std::max(std::abs(low), std::abs(high)) : 0; }
};

class Loader {
 public:
  Loader(const RawTable& table, const ColumnMap& map, const UnitChoice& units, Notes& notes)
      : table_(table), map_(map), units_(units), notes_(notes), needed_(table.rows(), true) {}

  Samples load(double plane_height) {
    Samples samples;
    for (std::size_t r = 0; r < samples.vectors.size(); ++r)
      if (const auto* columns = map_.find(static_cast<VectorRole>(r)))
        samples.vectors[r] = load_vector(static_cast<VectorRole>(r), *columns, plane_height);
    for (std::size_t r = 0; r < samples.scalars.size(); ++r)
      if (map_.scalars[r] >= 0)
        samples.scalars[r] = load_scalar(static_cast<ScalarRole>(r), map_.scalars[r]);
    add_fraction(samples);
    bad_.fail_if_any(table_.name);
    samples.block = table_.block;
    samples.length_guessed = length_guessed_;
    samples.force_guessed = force_guessed_;
    load_keys(samples);
    find_usable(samples);
    return samples;
  }

 private:
  std::vector<double> raw(int c, bool needed, bool clock) {
    const auto& cells = table_.columns[static_cast<std::size_t>(c)];
    std::vector<double> values(cells.size(), kNan);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (parse_number(cells[i], values[i]) || (clock && parse_clock(cells[i], values[i])))
        continue;
      values[i] = kNan;
      if (!is_missing(cells[i]))
        bad_.add(table_.header[static_cast<std::size_t>(c)], table_.line[i], cells[i]);
      if (needed) needed_[i] = false;
    }
    return values;
  }

  void add_fraction(Samples& samples) {
    if (map_.time_fraction < 0) return;
    const auto c = static_cast<std::size_t>(map_.time_fraction);
    const std::vector<double> fraction = raw(map_.time_fraction, true, false);
    auto& t = samples.scalars[static_cast<std::size_t>(ScalarRole::kTime)];
    for (std::size_t i = 0; i < t.size(); ++i) t[i] += map_.unit[c].factor * fraction[i];
  }

  // A unit that is written and not known must not be left unread.
  void refuse_unknown(int c, const std::string& flag) const {
    const std::string& unknown = map_.unknown[static_cast<std::size_t>(c)];
    if (unknown.empty() || units_.trusted) return;
    fail_input(table_.name,
               "the unit " + shown(unknown) + " of column " +
                   shown(table_.header[static_cast<std::size_t>(c)]) + " is not known",
               "say it by " + flag + ", or --yes where it is none");
  }

  static double factor_of(const std::string& unit, UnitKind kind, Quantity quantity) {
    const UnitName known = parse_unit(unit);
    return known.kind == kind ? known.factor : unit_factor(quantity, unit);
  }

  // Without a unit: a press is not a quarter of a metre deep, and a body not 1.5 m long.
  double guess_length(int c, const std::string& what, const Range& range, bool travel) {
    if (!units_.length.empty())
      return factor_of(units_.length, UnitKind::kLength, Quantity::kLength);
    refuse_unknown(c, "--unit");
    length_guessed_ = true;
    const bool millimetres =
        travel ? range.width() > 0.25 : range.width() > 1.5 || range.largest() > 10;
    if (millimetres)
      notes_.warnings.push_back(
          fmt::format("the {} has no unit and its size ({:.4g}) is taken for mm; say --unit mm or "
                      "name the unit",
                      what, travel ? range.width() : range.largest()));
    else
      notes_.facts.push_back("the " + what + " has no unit: taken for m");
    return millimetres ? 1e-3 : 1;
  }

  double force_factor(int c, const std::string& what) {
    if (!units_.force.empty()) return factor_of(units_.force, UnitKind::kForce, Quantity::kForce);
    refuse_unknown(c, "--force-unit");
    force_guessed_ = true;
    notes_.facts.push_back("the " + what + " has no unit: taken for N");
    return 1;
  }

  std::vector<Vec3> load_vector(VectorRole role, const std::array<int, 3>& columns,
                                double plane_height) {
    // What is not used if it is there need not be complete.
    const bool needed = role != VectorRole::kDesired && role != VectorRole::kDeformed;
    std::array<std::vector<double>, 3> parts;
    Range range;
    const UnitName* named = nullptr;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns[axis] < 0) continue;
      parts[axis] = raw(columns[axis], needed, false);
      const UnitName& unit = map_.unit[static_cast<std::size_t>(columns[axis])];
      if (unit.kind != UnitKind::kNone) named = &unit;
      Range own;
      for (const double value : parts[axis]) own.add(value);
      if (own.width() >= range.width()) range = {own.low, own.high};
      if (role != VectorRole::kDisplacement && own.largest() > 10)
        range.high = std::max(range.high, own.largest());
    }
    double factor = 1;
    if (role == VectorRole::kForce)
      factor = named ? named->factor : force_factor(columns[0], role_name(role));
    else if (role != VectorRole::kNormal)
      factor = named ? named->factor
                     : guess_length(columns[0], role_name(role), range,
                                    role == VectorRole::kDisplacement);
    std::vector<Vec3> vectors(table_.rows());
    for (std::size_t i = 0; i < vectors.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        vectors[i][static_cast<Eigen::Index>(axis)] =
            columns[axis] < 0 ? plane_height : factor * parts[axis][i];
    return vectors;
  }

  double time_factor(int c, const Range& range) {
    if (!units_.time.empty()) return factor_of(units_.time, UnitKind::kTime, Quantity::kTime);
    refuse_unknown(c, "--time-unit");
    // A clock since 1970 counts seconds up to 1e10, and a thousand times more with each finer unit.
    double factor = 1;
    const char* unit = "s";
    for (const auto& [limit, finer, name] :
         {std::tuple{1e17, 1e-9, "ns"}, {1e14, 1e-6, "us"}, {1e11, 1e-3, "ms"}})
      if (range.largest() > limit && factor == 1) {
        factor = finer;
        unit = name;
      }
    notes_.facts.push_back(fmt::format("the time has no unit: taken for {}", unit));
    const double step =
        range.width() / static_cast<double>(std::max<std::size_t>(table_.rows(), 2) - 1);
    if (factor == 1 && step > 5)
      notes_.warnings.push_back(
          fmt::format("samples are {:.3g} s apart; if the time is in ms say --time-unit ms", step));
    return factor;
  }

  std::vector<double> load_scalar(ScalarRole role, int c) {
    const bool needed =
        (role == ScalarRole::kDepth && !map_.has(VectorRole::kDisplacement) && !has_tip()) ||
        (role == ScalarRole::kForce && !map_.has(VectorRole::kForce)) || role == ScalarRole::kTime;
    std::vector<double> values = raw(c, needed, role == ScalarRole::kTime);
    Range range;
    for (const double value : values) range.add(value);
    const UnitName& unit = map_.unit[static_cast<std::size_t>(c)];
    double factor = 1;
    const bool named = unit.kind != UnitKind::kNone && unit.kind != UnitKind::kOther;
    if (role == ScalarRole::kTime) {
      factor = named ? unit.factor : time_factor(c, range);
      // Clocks since 1970 leave few digits for the time within a press.
      if (range.largest() * factor > 1e6)
        for (double& value : values) value -= range.low;
    } else if (role == ScalarRole::kDepth || role == ScalarRole::kGap) {
      factor = named ? unit.factor : needed ? guess_length(c, role_name(role), range, true) : 1;
    } else if (role == ScalarRole::kForce) {
      factor = named ? unit.factor : needed ? force_factor(c, role_name(role)) : 1;
    }
    const double offset = role == ScalarRole::kTemperature && named ? unit.offset : 0;
    if (role == ScalarRole::kTemperature && named) factor = unit.factor;
    for (double& value : values) value = factor * value + offset;
    return values;
  }

  bool has_tip() const { return map_.has(VectorRole::kTip); }

  void load_keys(Samples& samples) {
    if (map_.press.empty()) return;
    samples.key.assign(table_.rows(), "");
    for (const int c : map_.press)
      for (std::size_t i = 0; i < table_.rows(); ++i)
        samples.key[i] += table_.columns[static_cast<std::size_t>(c)][i] + "\x1f";
  }

  void find_usable(Samples& samples) {
    std::size_t missing = 0, failed = 0;
    const auto& fail = samples[ScalarRole::kFail];
    for (std::size_t i = 0; i < table_.rows(); ++i) {
      if (!fail.empty() && fail[i] > 0)
        ++failed;
      else if (!needed_[i])
        ++missing;
      else
        samples.usable.push_back(static_cast<int>(i));
    }
    if (failed)
      notes_.facts.push_back(fmt::format("{} rows marked as failed are left out", failed));
    if (missing == 0) return;
    const auto first = static_cast<std::size_t>(std::find(needed_.begin(), needed_.end(), false) -
                                                needed_.begin());
    if (5 * missing >= table_.rows())
      fail_input(
          table_.name + ":" + std::to_string(table_.line[first]),
          fmt::format("a number is missing here and in {} of {} rows", missing, table_.rows()),
          "see --list for what the columns were taken for, and --column X=skip");
    notes_.warnings.push_back(
        fmt::format("{} rows with missing numbers are left out (the first is line {})", missing,
                    table_.line[first]));
  }

  const RawTable& table_;
  const ColumnMap& map_;
  const UnitChoice& units_;
  Notes& notes_;
  BadCells bad_;
  std::vector<bool> needed_;
  bool length_guessed_ = false, force_guessed_ = false;
};

}  // namespace

Samples load_samples(const RawTable& table, const ColumnMap& map, const UnitChoice& units,
                     double plane_height, Notes& notes) {
  return Loader(table, map, units, notes).load(plane_height);
}

}  // namespace hapsim
