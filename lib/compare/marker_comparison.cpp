#include "compare/marker_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/counted.h"
#include "base/error.h"
#include "recording/force_noise.h"

namespace hapsim {
namespace {

constexpr double kMostOverNoise = 1.15;     // as forces within their doubt (wording.cpp)
constexpr double kSameRestPosition = 1e-4;  // [m]

using Key = std::tuple<std::string, int, long long>;  // point, press, nanosecond

// Presses are told apart where both tables do.
Key key_of(const MarkerTable& table, std::size_t row, bool by_press) {
  return {table.points[static_cast<std::size_t>(table.point[row])], by_press ? table.press[row] : 0,
          std::llround(1e9 * table.t[row])};
}

void measure_noise(const MarkerTable& table, MarkerComparison& c) {
  if (const auto declared = table.noise()) {
    c.noise = *declared;
    c.noise_origin = "declared";
    return;
  }
  // As forces of presses, one a point and press.
  std::map<std::pair<int, int>, std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < table.rows(); ++row)
    rows[{table.point[row], table.press.empty() ? 0 : table.press[row]}].push_back(row);
  Recording as_forces;
  int press = 0;
  for (const auto& [key, of] : rows) {
    ++press;
    for (const std::size_t row : of) {
      as_forces.press.push_back(press);
      as_forces.t.push_back(table.t[row]);
      as_forces.u.push_back(table.u[row]);
      as_forces.f.push_back(table.u[row]);
    }
  }
  c.noise = std::max({measure_force_noise(as_forces).sigma, 1e-4 * c.size, 1e-9});
  c.noise_origin = "measured from the data";
}

}  // namespace

MarkerComparison compare_markers(const MarkerTable& measured, const MarkerTable& simulated) {
  MarkerComparison c;
  const bool by_press = !measured.press.empty() && !simulated.press.empty();
  std::map<std::string, Vec3> rest;
  for (std::size_t p = 0; p < simulated.points.size(); ++p)
    rest[simulated.points[p]] = simulated.rest[p];
  for (std::size_t p = 0; p < measured.points.size(); ++p)
    if (const auto other = rest.find(measured.points[p]);
        other != rest.end() && (other->second - measured.rest[p]).norm() > kSameRestPosition)
      fail_input(simulated.name,
                 "the rest position of point " + measured.points[p] + " is another than in " +
                     measured.name,
                 "simulate these very points: hs-simulate ... --markers " + measured.name);
  std::map<Key, std::size_t> found;
  for (std::size_t row = 0; row < simulated.rows(); ++row)
    found[key_of(simulated, row, by_press)] = row;
  std::vector<double> squares(measured.points.size(), 0);
  c.points.resize(measured.points.size());
  double all = 0, size = 0;
  for (std::size_t row = 0; row < measured.rows(); ++row) {
    const auto other = found.find(key_of(measured, row, by_press));
    if (other == found.end()) {
      ++c.missing;
      continue;
    }
    const auto p = static_cast<std::size_t>(measured.point[row]);
    const double off = (measured.u[row] - simulated.u[other->second]).squaredNorm();
    squares[p] += off;
    all += off;
    size += measured.u[row].squaredNorm();
    ++c.points[p].rows;
    ++c.rows;
  }
  if (c.rows == 0)
    fail_input(simulated.name, "no row has a point and time of " + measured.name,
               "simulate these very points: hs-simulate ... --markers " + measured.name);
  for (std::size_t p = 0; p < squares.size(); ++p) {
    c.points[p].name = measured.points[p];
    if (c.points[p].rows > 0)
      c.points[p].rms = std::sqrt(squares[p] / (3 * static_cast<double>(c.points[p].rows)));
  }
  std::stable_sort(c.points.begin(), c.points.end(),
                   [](const auto& a, const auto& b) { return a.rms > b.rms; });
  const double components = 3 * static_cast<double>(c.rows);
  c.rms = std::sqrt(all / components);
  c.size = std::sqrt(size / components);
  c.mesh = simulated.metadata.number("marker_uncertainty", simulated.name).value_or(0);
  measure_noise(measured, c);
  return c;
}

bool markers_explained(const MarkerComparison& c) {
  return c.rms <= kMostOverNoise * std::hypot(c.noise, c.mesh);
}

std::vector<std::string> marker_facts(const MarkerComparison& c) {
  std::vector<std::string> facts{fmt::format(
      "error {:.3g} mm = {:.2g} x noise ({:.3g} mm, {}), of displacements of {:.3g} mm rms over {} "
      "of {}",
      1e3 * c.rms, c.rms / c.noise, 1e3 * c.noise, c.noise_origin, 1e3 * c.size,
      counted(static_cast<std::ptrdiff_t>(c.rows), "row", "rows"),
      counted(static_cast<std::ptrdiff_t>(c.points.size()), "point", "points"))};
  constexpr std::size_t kMost = 3;
  std::string worst;
  for (std::size_t p = 0; p < std::min(kMost, c.points.size()); ++p)
    worst += fmt::format("{}{} {:.3g} mm", p == 0 ? "worst: " : ", ", c.points[p].name,
                         1e3 * c.points[p].rms);
  facts.push_back(worst);
  if (c.missing > 0)
    facts.push_back(
        counted(static_cast<std::ptrdiff_t>(c.missing), "measured row has", "measured rows have") +
        " no simulated one");
  return facts;
}

}  // namespace hapsim
