#include "compare/report_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/gain_sentences.h"
#include "compare/wording.h"
#include "model/interval.h"

namespace hapsim {
namespace {

double number_or_nan(const CsvTable& table, const char* column, std::size_t row) {
  const int c = table.find(column);
  double value = 0;
  if (c < 0 || !parse_number(table.columns[static_cast<std::size_t>(c)][row], value))
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

ReportTable report_table(const Breakdown& breakdown, const char* first_column,
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

}  // namespace

void add_history(const CsvTable& table, Report& report) {
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
    const int effects = table.find("effects");
    report.versions.push_back(
        {effects < 0 ? "" : table.columns[static_cast<std::size_t>(effects)][r],
         number_or_nan(table, "rmse", r), number_or_nan(table, "heldout", r),
         number_or_nan(table, "noise", r)});
  }
  for (std::string& name : report.history.columns)
    if (name == "rmse" || name == "heldout" || name == "noise" || name == "force_rms")
      name += " [N]";
}

void add_diagnosis(const CsvTable& table, const std::string& version, Report& report) {
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
    row.p_value = p;
    if (std::isfinite(p))
      row.facts.emplace_back("chance of a false alarm",
                             p < 1e-3 ? "below 0.001" : fmt::format("{:.2g}", p));
    if (!cell("confused_with", r).empty())
      row.facts.emplace_back(
          row.verdict == "indistinguishable" ? "cannot be told from" : "alone nearly as good",
          cell("confused_with", r));
    for (const auto& [column, name] :
         {std::pair{"where", "where it acts"}, std::pair{"evidence", "evidence"},
          std::pair{"next_measurement", kNextMeasurement}})
      if (!cell(column, r).empty()) row.notes.emplace_back(name, cell(column, r));
    row.command = cell("command", r);
    report.diagnoses.back().rows.push_back(std::move(row));
  }
}

void add_parameters(const Model& model, Report& report) {
  ReportTable& t = report.parameters;
  t.caption =
      "± is one standard error, of sizes and moduli that of their logarithm times the value; in 95 "
      "of 100 recordings the interval holds the value that "
      "this kind of model would have.";
  t.columns = {"effect", "region", "parameter", "value", "±", "95 % interval", "unit", "state"};
  constexpr std::size_t kMost = 60;
  for (const Parameter& p : model.parameters) {
    if (t.rows.size() == kMost) {
      t.caption += fmt::format(" The first {} of {}.", kMost, model.parameters.size());
      break;
    }
    const ParameterInterval interval = interval95(p);
    const bool known = interval.known();
    t.rows.push_back({p.effect, std::to_string(p.region), p.name, fmt::format("{:.4g}", p.value),
                      known ? fmt::format("{:.2g}", p.std_error) : "",
                      known ? fmt::format("{:.4g} to {:.4g}", interval.lower, interval.upper) : "",
                      p.unit == "1" ? "" : p.unit,
                      p.state == ParameterState::kFree      ? "fitted"
                      : p.state == ParameterState::kDerived ? "derived"
                                                            : "fixed"});
  }
}

void add_tables(const Comparison& c, Report& report) {
  std::vector<int> all;
  for (const Breakdown& b : c.breakdowns) {
    all.clear();
    for (std::size_t i = 0; i < b.errors.size(); ++i) all.push_back(static_cast<int>(i));
    const bool positions = &b == &c.by_position();
    report.tables.push_back(report_table(b, positions ? "position (x, y, z)" : "group",
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

void add_numbers(const Comparison& c, const Metadata& simulated, Report& report) {
  report.numbers = {
      {"typical error (rmse)", newtons(c.size.rmse),
       fmt::format("{} of the force's rms, {} of its peak",
                   percent_of(c.size.rmse, c.size.force_rms),
                   percent_of(c.size.rmse, c.size.force_peak))},
      {"sensor noise", c.noise.value > 0 ? newtons(c.noise.value) : "unknown", c.noise.origin},
      {"error over noise", c.noise.value > 0 ? times_noise(c) + " ×" : "-",
       "1 × when nothing but noise is left"}};
  if (const auto share = simulated.number("mesh_uncertainty", "simulated")) {
    report.mesh_uncertainty = *share * c.size.force_rms;
    report.numbers.push_back(
        {"mesh uncertainty", newtons(report.mesh_uncertainty),
         fmt::format("{:.2g} % of the force, as hs-simulate says", 100 * *share)});
  }
  if (c.torque.compared()) {
    const TorqueError& e = c.torque.error;
    report.numbers.push_back(
        {"torque error (rmse)", fmt::format("{:.3g} N m", e.rms),
         fmt::format("{:.2g} × its noise of {:.3g} N m ({}), of torques of {:.3g} N m",
                     e.rms / e.noise, e.noise, e.noise_origin, e.size)});
  }
  if (c.markers) {
    const MarkerComparison& m = *c.markers;
    report.numbers.push_back(
        {"marked points, error (rmse)", fmt::format("{:.3g} mm", 1e3 * m.rms),
         fmt::format("{:.2g} × their noise of {:.3g} mm ({}), of {:.3g} mm; {} is off most, by "
                     "{:.3g} mm",
                     m.rms / m.noise, 1e3 * m.noise, m.noise_origin, 1e3 * m.size,
                     m.points.front().name, 1e3 * m.points.front().rms)});
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
