// Lays a comparison out as a report: names, units and rounding, no statistics.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/tool.h"
#include "compare/comparison.h"
#include "compare/gain_sentences.h"
#include "compare/trend.h"
#include "io/csv.h"
#include "report/report.h"

namespace hapsim {

// A simulated recording under the name it is shown by.
struct Version {
  std::string name;
  Recording recording;
};

inline std::string newtons(double force) {
  return fmt::format("{:.3g} N", force);
}
inline std::string percent_of(double part, double whole) {
  return whole > 0 ? fmt::format("{:.2g} %", 100 * part / whole) : "-";
}
inline std::string times_noise(const Comparison& c) {
  return c.noise.value > 0 ? fmt::format("{:.2g}", c.size.rmse / c.noise.value) : "?";
}

inline std::string verdict_line(const Comparison& c) {
  if (c.observations.empty() && c.size.rmse <= 1.15 * c.noise.value)
    return fmt::format("Nothing is left but sensor noise: typical error {}, noise {}.",
                       newtons(c.size.rmse), newtons(c.noise.value));
  std::string text =
      fmt::format("The model misses the measurement by typically {}, {} of the force",
                  newtons(c.size.rmse), percent_of(c.size.rmse, c.size.force_rms));
  if (c.noise.value > 0) text += fmt::format(" and {} times the sensor noise", times_noise(c));
  return text + ".";
}

inline double number_or_nan(const CsvTable& table, const char* column, std::size_t row) {
  const int c = table.find(column);
  double value = 0;
  if (c < 0 || !parse_number(table.columns[static_cast<std::size_t>(c)][row], value))
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

inline void add_history(const CsvTable& table, Report& report) {
  report.history.columns = table.header;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    std::vector<std::string> cells;
    for (const auto& column : table.columns) {
      double value = 0;
      const bool fraction = column[r].find_first_of(".eE") != std::string::npos;
      cells.push_back(fraction && parse_number(column[r], value) ? fmt::format("{:.4g}", value)
                                                                 : column[r]);
    }
    report.history.rows.push_back(cells);
    report.versions.push_back({"", number_or_nan(table, "rmse", r),
                               number_or_nan(table, "heldout", r),
                               number_or_nan(table, "noise", r)});
  }
  for (std::string& name : report.history.columns)
    if (name == "rmse" || name == "heldout" || name == "noise" || name == "force_rms")
      name += " [N]";
}

inline void add_diagnosis(const CsvTable& table, const std::string& version, Report& report) {
  report.diagnoses.push_back({version, {}});
  const auto cell = [&](const char* column, std::size_t r) {
    const int c = table.find(column);
    return c < 0 ? std::string() : table.columns[static_cast<std::size_t>(c)][r];
  };
  for (std::size_t r = 0; r < table.rows(); ++r) {
    DiagnosisRow row{cell("rank", r), cell("effect", r), cell("verdict", r), {}, {}, ""};
    const auto change = [&](const char* name, const char* before, const char* after) {
      const double a = number_or_nan(table, before, r), b = number_or_nan(table, after, r);
      if (!std::isfinite(a)) return;
      row.facts.emplace_back(
          name, std::isfinite(b) ? fmt::format("{:.3g} to {:.3g} N", a, b) : newtons(a));
    };
    change("error of the fit", "rmse_now", "rmse_after");
    change("error on unseen positions", "heldout_now", "heldout_after");
    const double p = number_or_nan(table, "p_value", r);
    if (std::isfinite(p))
      row.facts.emplace_back("chance of a false alarm",
                             p < 1e-3 ? "below 0.001" : fmt::format("{:.2g}", p));
    if (!cell("confused_with", r).empty())
      row.facts.emplace_back(
          row.verdict == "indistinguishable" ? "cannot be told from" : "alone nearly as good",
          cell("confused_with", r));
    for (const auto& [column, name] :
         {std::pair{"where", "where it acts"}, std::pair{"evidence", "evidence"},
          std::pair{"next_measurement", "what to measure next"}})
      if (!cell(column, r).empty()) row.notes.emplace_back(name, cell(column, r));
    row.command = cell("command", r);
    report.diagnoses.back().rows.push_back(std::move(row));
  }
}

inline ReportTable report_table(const Breakdown& breakdown, const char* first_column,
                                const std::vector<int>& order, bool ranked) {
  ReportTable table{breakdown.grouping.title,
                    {first_column, "rows", "presses", "the model is", "rmse [N]"},
                    {},
                    {}};
  double largest = 0;
  for (const BinError& e : breakdown.errors) largest = std::max(largest, e.rmse);
  for (const int b : order) {
    const BinError& e = breakdown.errors[static_cast<std::size_t>(b)];
    if (e.rows == 0) continue;
    const bool gain = e.gain > 0.1 && e.gain_error < 0.5;
    std::string stiff = gain ? stiffness_words(e) : "-";
    if (stiff.rfind("too", 0) == 0)
      stiff += fmt::format(" ± {:.1f} %", 100 * e.gain_error / (e.gain * e.gain));
    std::string label = breakdown.grouping.bins[static_cast<std::size_t>(b)].label;
    if (ranked) label = fmt::format("{}.  {}", table.rows.size() + 1, label);
    table.rows.push_back({label, std::to_string(e.rows), std::to_string(e.presses), stiff,
                          fmt::format("{:.3g}", e.rmse)});
    table.bar.push_back(largest > 0 ? e.rmse / largest : 0);
  }
  return table;
}

inline void add_tables(const Comparison& c, Report& report) {
  std::vector<int> all;
  for (const Breakdown& b : c.breakdowns) {
    all.clear();
    for (std::size_t i = 0; i < b.errors.size(); ++i) all.push_back(static_cast<int>(i));
    const bool positions = &b == &c.by_position();
    report.tables.push_back(report_table(b, positions ? "position (x, y, z)" : "",
                                         positions ? c.worst_positions() : all, positions));
  }
  ReportTable& first = report.tables.front();
  constexpr std::size_t kMost = 200;
  if (first.rows.size() > kMost) {
    first.caption += fmt::format(", the worst {} of {}", kMost, first.rows.size());
    first.rows.resize(kMost);
    first.bar.resize(kMost);
  }
}

inline void add_residual_plots(const Recording& measured, const Recording& simulated,
                               const Comparison& c, Report& report) {
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

inline void add_presses(const Recording& measured, const std::vector<Version>& versions,
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
  for (const Version& v : versions) report.curves.push_back(v.name);
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

inline void add_numbers(const Comparison& c, const Metadata& simulated, Report& report) {
  report.numbers = {{"typical error (rmse)", newtons(c.size.rmse),
                     fmt::format("{} of the force's rms, {} of its peak",
                                 percent_of(c.size.rmse, c.size.force_rms),
                                 percent_of(c.size.rmse, c.size.force_peak))},
                    {"sensor noise", c.noise.value > 0 ? newtons(c.noise.value) : "unknown",
                     c.noise.estimated ? "estimated from differences in time"
                                       : "declared in the recording (force_noise)"},
                    {"error over noise", c.noise.value > 0 ? times_noise(c) + " ×" : "-",
                     "1 × when nothing but noise is left"}};
  if (const auto share = simulated.number("mesh_uncertainty", "simulated")) {
    report.mesh_uncertainty = *share * c.size.force_rms;
    report.numbers.push_back(
        {"mesh uncertainty", newtons(report.mesh_uncertainty),
         fmt::format("{:.2g} % of the force, as hs-simulate says", 100 * *share)});
  }
  for (auto version = report.versions.rbegin(); version != report.versions.rend(); ++version)
    if (std::isfinite(version->held_out)) {
      report.numbers.push_back({"error on unseen positions", newtons(version->held_out),
                                "held out, latest model version that has it"});
      break;
    }
  const Vec3& axis = c.size.rmse_axis;
  report.numbers.push_back(
      {"recording", fmt::format("{} presses", c.facts.press_ids.size()),
       fmt::format("at {} positions, {} rows; rmse x {:.2g}, y {:.2g}, z {:.2g} N",
                   c.facts.positions.size(), c.facts.press.size(), axis[0], axis[1], axis[2])});
}

}  // namespace hapsim
