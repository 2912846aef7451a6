#include "recording/marker_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "io/csv.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr double kFarthest = 10;      // [m]; beyond it the unit is wrong
constexpr double kMostMoved = 1;      // [m]
constexpr double kSameRest = 1e-5;    // [m]
constexpr double kMostNoise = 0.1;    // [m]
constexpr double kLeastNoise = 1e-9;  // [m]

// "ux_mm", "ux [mm]", "ux(mm)" are `name` with a unit.
struct UnitColumn {
  int column = -1;
  double factor = 1;  // to SI
};

UnitColumn find_with_unit(const CsvTable& table, const std::string& name, Quantity quantity) {
  if (const int exact = table.find(name); exact >= 0) return {exact, 1};
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const std::string& head = table.header[c];
    if (head.compare(0, name.size(), name) != 0) continue;
    std::string unit = head.substr(name.size());
    if (unit.find_first_of("_ [(") != 0) continue;
    std::erase_if(unit, [](char ch) { return ch == '_' || ch == ' '; });
    for (const char* brackets : {"[]", "()"})
      if (unit.size() > 2 && unit.front() == brackets[0] && unit.back() == brackets[1])
        unit = unit.substr(1, unit.size() - 2);
    try {
      return {static_cast<int>(c), unit_factor(quantity, unit)};
    } catch (const Error&) {
      fail_input(table.name, fmt::format("column '{}' has a unit that is not known", head),
                 fmt::format("known are {}: {}_{}", known_units(quantity), name,
                             quantity == Quantity::kTime ? "ms" : "mm"));
    }
  }
  return {};
}

std::vector<double> in_si(const CsvTable& table, const std::string& name, Quantity quantity,
                          double most) {
  const UnitColumn found = find_with_unit(table, name, quantity);
  if (found.column < 0) fail_missing_column(table.name, name, table.header);
  std::vector<double> values = table.numbers(table.header[static_cast<std::size_t>(found.column)]);
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] *= found.factor;
    if (std::abs(values[row]) > most)
      fail_input(table.name + ":" + std::to_string(table.line[row]),
                 fmt::format("{} is {:.6g} m, beyond {:g} m", name, values[row], most),
                 fmt::format("are these millimetres? name the column {}_mm", name));
  }
  return values;
}

std::vector<Vec3> vectors(const CsvTable& table, const std::string& prefix, double most) {
  std::vector<Vec3> all(table.rows());
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::vector<double> values = in_si(table, prefix + "xyz"[k], Quantity::kLength, most);
    for (std::size_t row = 0; row < all.size(); ++row) all[row][k] = values[row];
  }
  return all;
}

}  // namespace

std::optional<double> MarkerTable::noise() const {
  const auto value = metadata.number("marker_noise", name);
  if (!value) return std::nullopt;
  if (!(*value >= kLeastNoise && *value <= kMostNoise))
    fail_input(name, "marker_noise " + format_number(*value) + " is not between 1e-9 and 0.1 m",
               "give the standard deviation of a component in m, or remove the line");
  return value;
}

MarkerTable read_markers(Input& input, bool need_motion) {
  const CsvTable csv = read_csv(input);
  MarkerTable table;
  table.name = csv.name;
  table.metadata = csv.metadata;
  if (csv.find("point") < 0) fail_missing_column(csv.name, "point", csv.header);
  if (csv.rows() == 0) fail_input(csv.name, "there is a header but no row", "add the points");
  const std::vector<Vec3> rest = vectors(csv, "", kFarthest);
  const std::vector<std::string>& names = csv.columns[static_cast<std::size_t>(csv.find("point"))];
  std::map<std::string, int> known;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const auto [found, is_new] =
        known.try_emplace(names[row], static_cast<int>(table.points.size()));
    if (is_new) {
      table.points.push_back(names[row]);
      table.rest.push_back(rest[row]);
    } else if ((rest[row] - table.rest[static_cast<std::size_t>(found->second)])
                   .cwiseAbs()
                   .maxCoeff() > kSameRest) {
      fail_input(csv.name + ":" + std::to_string(csv.line[row]),
                 "the rest position of point " + names[row] + " is another than before",
                 "give where the point lies on the unpressed body in x,y,z, and how far it has "
                 "moved from there in ux,uy,uz");
    }
    table.point.push_back(found->second);
  }
  const bool moves = find_with_unit(csv, "t", Quantity::kTime).column >= 0 ||
                     find_with_unit(csv, "ux", Quantity::kLength).column >= 0;
  if (!need_motion && !moves) {
    table.point.clear();
    return table;
  }
  table.line = csv.line;
  table.t = in_si(csv, "t", Quantity::kTime, std::numeric_limits<double>::infinity());
  table.u = vectors(csv, "u", kMostMoved);
  if (csv.find("press") >= 0)
    for (const double press : csv.numbers("press")) {
      if (std::abs(press) > INT_MAX || press != std::floor(press))
        fail_input(csv.name, "press is " + format_number(press) + ", not an integer",
                   "give the press of the recording in which the point was seen");
      table.press.push_back(static_cast<int>(press));
    }
  table.noise();
  return table;
}

void write_markers(std::ostream& out, const MarkerTable& table) {
  std::vector<std::string> header{"point", "t", "x", "y", "z", "ux", "uy", "uz"};
  if (!table.press.empty()) header.emplace_back("press");
  CsvWriter csv(out, table.metadata, header);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto p = static_cast<std::size_t>(table.point[row]);
    std::vector<std::string> fields{table.points[p], format_number(table.t[row])};
    for (const Vec3& v : {table.rest[p], table.u[row]})
      for (int k = 0; k < 3; ++k) fields.push_back(format_number(v[k]));
    if (!table.press.empty()) fields.push_back(std::to_string(table.press[row]));
    csv.row(fields);
  }
}

void add_marker_noise(MarkerTable& table, double noise, std::uint64_t seed) {
  constexpr std::uint64_t kOther = 0x6d61726b;  // than the forces' numbers
  if (noise == 0) return;
  if (noise < kLeastNoise || noise > kMostNoise)
    fail_usage(fmt::format("{:g} m is no noise of a point's displacement", noise),
               fmt::format("give one from {:g} to {:g} m", kLeastNoise, kMostNoise));
  Random random(seed ^ kOther);
  for (Vec3& u : table.u)
    for (int k = 0; k < 3; ++k) u[k] += noise * random.normal();
  table.metadata.set("marker_noise", format_number(noise));
  table.metadata.set("seed", std::to_string(seed));
}

}  // namespace hapsim
