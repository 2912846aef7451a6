#include "compare/report_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/trend.h"

namespace hapsim {

void add_residual_plots(const Recording& measured, const Recording& simulated, const Comparison& c,
                        Report& report) {
  constexpr int kGroups = 12;
  constexpr std::size_t kPoints = 1600;
  const RowFacts& facts = c.facts;
  std::vector<double> y;
  for (std::size_t i = 0; i < measured.rows(); ++i)
    y.push_back(facts.normal[static_cast<std::size_t>(facts.position[i])].dot(measured.f[i] -
                                                                              simulated.f[i]));
  // Every so manieth row, so that the cloud keeps its density.
  std::vector<std::size_t> shown;
  const std::size_t stride = std::max<std::size_t>(1, y.size() / kPoints);
  for (std::size_t i = 0; i < y.size(); i += stride) shown.push_back(i);
  const auto add = [&](const char* label, const std::vector<double>& values, double scale) {
    if (values.empty()) return;
    std::vector<double> x;
    for (const double v : values) x.push_back(scale * v);
    Trend trend = binned_trend(x, y, facts.press, kGroups);
    ResidualPlot plot{label, {}, {}, trend.centre, trend.mean, trend.error};
    for (const std::size_t i : shown) {
      plot.x.push_back(x[i]);
      plot.y.push_back(y[i]);
    }
    report.residuals.push_back(std::move(plot));
  };
  add("depth [mm]", facts.depth, 1e3);
  add("speed of the tool [mm/s]", facts.rate, 1e3);
  add("time since contact [s]", facts.contact_age, 1);
  add("time in the session [s]", facts.session, 1);
}

void add_presses(const Recording& measured, const std::vector<SimulatedVersion>& versions,
                 const Comparison& c, Report& report) {
  constexpr std::size_t kMostPresses = 2000, kNumbers = 400000;
  const std::vector<Press> presses = measured.presses();
  std::vector<std::pair<double, std::size_t>> order;  // minus the error, index
  for (std::size_t p = 0; p < presses.size(); ++p) {
    double square = 0;
    for (const int row : presses[p].rows)
      square += (measured.f[row] - versions.back().recording.f[row]).squaredNorm();
    order.emplace_back(-std::sqrt(square / (3.0 * static_cast<double>(presses[p].rows.size()))), p);
  }
  std::sort(order.begin(), order.end());
  const std::size_t kept = std::min(order.size(), kMostPresses);
  const std::size_t points =
      std::clamp<std::size_t>(kNumbers / (kept * (4 + 3 * versions.size())), 60, 300);
  if (kept < order.size())
    report.presses_note =
        fmt::format("Only the {} presses with the largest error are in this file. ", kept);
  report.presses_note +=
      fmt::format("Long presses are thinned to about {} points; peaks are kept.", points);
  if (measured.t.empty()) report.time_label = "row of the press";
  for (const SimulatedVersion& v : versions) report.curves.push_back(v.name);
  order.resize(kept);
  std::sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.second < b.second; });
  for (const auto& [minus_error, p] : order) {
    const std::vector<int>& rows = presses[p].rows;
    ReportPress press;
    press.id = presses[p].id;
    press.position = c.facts.position[static_cast<std::size_t>(rows.front())];
    press.rmse = -minus_error;
    int peak = rows.front();
    double depth = 0;
    for (const int row : rows) {
      if (measured.f[row].norm() > measured.f[peak].norm()) peak = row;
      depth = std::max(depth, measured.u[row].norm());
    }
    const Vec3 mm = 1e3 * measured.position[static_cast<std::size_t>(rows.front())];
    press.place = fmt::format("({:.1f}, {:.1f}, {:.1f}) mm, {:.2g} mm deep{}", mm[0], mm[1], mm[2],
                              1e3 * depth, c.facts.sideways[p] != 0 ? ", sideways" : "");
    if (measured.f[peak].norm() > 0) press.direction = measured.f[peak].normalized();
    std::vector<double> along;
    for (const int row : rows) along.push_back(press.direction.dot(measured.f[row]));
    press.simulated.resize(versions.size());
    for (const std::size_t i : thinned(along, points)) {
      const int row = rows[i];
      press.t.push_back(measured.t.empty() ? static_cast<double>(i)
                                           : measured.t[row] - measured.t[rows.front()]);
      press.measured.push_back(measured.f[row]);
      for (std::size_t v = 0; v < versions.size(); ++v)
        press.simulated[v].push_back(versions[v].recording.f[row]);
    }
    report.presses.push_back(std::move(press));
  }
}

}  // namespace hapsim
