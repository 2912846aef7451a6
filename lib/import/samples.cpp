#include "import/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/units.h"
#include "import/raw_rows.h"
#include "io/csv.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// "12:03:01.25" as seconds.
bool parse_clock(std::string_view text, double& seconds) {
  seconds = 0;
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
    bad_.fail_if_any(table_.name);
    samples.block = table_.block;
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

  // Without a unit: a press is not a quarter of a metre deep, and a body not 1.5 m long.
  double guess_length(const std::string& what, const Range& range, bool travel) {
    if (!units_.length.empty()) return unit_factor(Quantity::kLength, units_.length);
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

  double force_factor(const std::string& what) {
    if (!units_.force.empty()) return unit_factor(Quantity::kForce, units_.force);
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
      factor = named ? named->factor : force_factor(role_name(role));
    else if (role != VectorRole::kNormal)
      factor = named ? named->factor
                     : guess_length(role_name(role), range, role == VectorRole::kDisplacement);
    std::vector<Vec3> vectors(table_.rows());
    for (std::size_t i = 0; i < vectors.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        vectors[i][static_cast<Eigen::Index>(axis)] =
            columns[axis] < 0 ? plane_height : factor * parts[axis][i];
    return vectors;
  }

  double time_factor(const Range& range) {
    if (!units_.time.empty()) return unit_factor(Quantity::kTime, units_.time);
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
      factor = named ? unit.factor : time_factor(range);
      // Clocks since 1970 leave few digits for the time within a press.
      if (range.largest() * factor > 1e6)
        for (double& value : values) value -= range.low;
    } else if (role == ScalarRole::kDepth) {
      factor = named ? unit.factor : needed ? guess_length(role_name(role), range, true) : 1;
    } else if (role == ScalarRole::kForce) {
      factor = named ? unit.factor : needed ? force_factor(role_name(role)) : 1;
    }
    for (double& value : values) value *= factor;
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
};

}  // namespace

Samples load_samples(const RawTable& table, const ColumnMap& map, const UnitChoice& units,
                     double plane_height, Notes& notes) {
  return Loader(table, map, units, notes).load(plane_height);
}

}  // namespace hapsim
