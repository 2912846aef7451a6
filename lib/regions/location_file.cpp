#include "regions/location_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

constexpr std::size_t kLeastSamples = 4;
constexpr double kSamePoint = 1e-6;  // [m]

void check_row(const LocationTable& t, std::size_t row, long line) {
  const std::string where = t.name + ":" + std::to_string(line);
  if (!(t.E[row] > 0))
    fail_input(where, "E = " + format_number(t.E[row]) + " Pa is not positive",
               "remove the sample, or press there again");
  if (!(t.E_std[row] > 0))
    fail_input(where, "E_std = " + format_number(t.E_std[row]) + " Pa is not positive",
               "give the standard error of E");
  if (t.nu[row] < 0 || t.nu[row] >= 0.5)
    fail_input(where, "nu = " + format_number(t.nu[row]) + " lies outside [0, 0.5)",
               "remove the sample, or hold nu when it is estimated");
  if (t.nu_std[row] < 0)
    fail_input(where, "nu_std is negative", "give the standard error of nu, 0 when it was held");
  if (t.point[row].cwiseAbs().maxCoeff() > 10)
    fail_input(where, "the position is more than 10 m away", "give positions in metres");
}

}  // namespace

LocationTable read_locations(Input& input) {
  const CsvTable csv = read_csv(input);
  LocationTable t;
  t.name = csv.name;
  t.metadata = csv.metadata;
  const auto x = csv.numbers("x"), y = csv.numbers("y"), z = csv.numbers("z");
  t.E = csv.numbers("E");
  t.nu = csv.numbers("nu");
  t.E_std = csv.numbers("E_std");
  t.nu_std = csv.numbers("nu_std");
  t.n.assign(csv.rows(), 1);
  if (csv.find("n") >= 0) {
    const std::vector<double> n = csv.numbers("n");
    std::transform(n.begin(), n.end(), t.n.begin(),
                   [](double v) { return static_cast<int>(std::clamp(v, 0.0, 2e9)); });
  }
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    t.point.emplace_back(x[i], y[i], z[i]);
    check_row(t, i, csv.line[i]);
  }
  static const std::vector<std::string> kKnown{"x",     "y",      "z", "E",     "nu",
                                               "E_std", "nu_std", "n", "region"};
  for (std::size_t c = 0; c < csv.header.size(); ++c)
    if (std::find(kKnown.begin(), kKnown.end(), csv.header[c]) == kKnown.end()) {
      t.extra_header.push_back(csv.header[c]);
      t.extra.push_back(csv.columns[c]);
    }
  if (t.size() < kLeastSamples)
    fail_input(t.name, fmt::format("{} location samples are too few", t.size()),
               "press at four places or more, better at twenty");
  const auto held = std::count(t.nu_std.begin(), t.nu_std.end(), 0.0);
  if (held != 0 && held != static_cast<long>(t.size()))
    fail_input(t.name, fmt::format("nu_std is 0 in {} of {} rows", held, t.size()),
               "give the standard error of nu in every row, or 0 in all when nu was held");
  const bool one_place = std::all_of(t.point.begin(), t.point.end(), [&](const Vec3& p) {
    return (p - t.point.front()).norm() < kSamePoint;
  });
  if (one_place)
    fail_input(t.name, "all location samples lie at one place",
               "regions need samples from several contact positions");
  return t;
}

void write_locations(std::ostream& out, const LocationTable& t) {
  std::vector<std::string> header{"x", "y", "z", "E", "nu", "E_std", "nu_std", "n"};
  if (!t.region.empty()) header.emplace_back("region");
  header.insert(header.end(), t.extra_header.begin(), t.extra_header.end());
  CsvWriter writer(out, t.metadata, header);
  for (std::size_t i = 0; i < t.size(); ++i) {
    std::vector<std::string> row;
    for (const double v :
         {t.point[i].x(), t.point[i].y(), t.point[i].z(), t.E[i], t.nu[i], t.E_std[i], t.nu_std[i]})
      row.push_back(format_number(v));
    row.push_back(std::to_string(t.n[i]));
    if (!t.region.empty()) row.push_back(std::to_string(t.region[i]));
    for (const auto& column : t.extra) row.push_back(column[i]);
    writer.row(row);
  }
}

}  // namespace hapsim
