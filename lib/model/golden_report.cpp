#include "model/golden_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

// "2%" or "0.01"; false when it is neither, or negative.
bool read_tolerance(std::string_view text, Tolerance& tolerance) {
  text = trim(text);
  tolerance.relative = !text.empty() && text.back() == '%';
  if (tolerance.relative) text.remove_suffix(1);
  if (!parse_number(text, tolerance.value) || tolerance.value < 0) return false;
  if (tolerance.relative) tolerance.value /= 100;
  return true;
}

std::string name_of(const GoldenRow& row) {
  const std::string name = row.effect.empty() ? row.parameter : row.effect + "." + row.parameter;
  return row.region == 0 ? name : fmt::format("{}[{}]", name, row.region);
}

}  // namespace

Tolerance parse_tolerance(const std::string& text, const std::string& option) {
  Tolerance tolerance;
  const std::size_t equals = text.find('=');
  if (equals != text.npos) tolerance.parameter = text.substr(0, equals);
  if (!read_tolerance(equals == text.npos ? text : text.substr(equals + 1), tolerance))
    fail_usage(option + " " + shown(text) + " is no tolerance",
               "give 2%, or for one parameter nu=0.01 or elastic.E=2%");
  return tolerance;
}

double parse_share(const std::string& text, const std::string& option) {
  Tolerance share;
  if (!read_tolerance(text, share))
    fail_usage(option + " " + shown(text) + " is no share", "give 10% or 0.1");
  return share.value;
}

void require_named(const std::vector<Tolerance>& tolerances, const std::vector<GoldenRow>& rows,
                   const std::string& option) {
  for (const Tolerance& t : tolerances) {
    const bool fits = std::any_of(rows.begin(), rows.end(), [&](const GoldenRow& row) {
      return t.parameter.empty() || t.parameter == row.parameter ||
             t.parameter == row.effect + "." + row.parameter;
    });
    if (!fits)
      fail_usage(option + ": no parameter is named '" + t.parameter + "'", "write elastic.E=2%");
  }
}

void write_golden(std::ostream& out, const std::vector<GoldenRow>& rows) {
  CsvWriter table(out, {},
                  {"effect", "region", "parameter", "value", "golden", "allowed", "verdict"});
  const auto number = [](double v) { return std::isfinite(v) ? format_number(v) : std::string(); };
  for (const GoldenRow& row : rows)
    table.row({row.effect, std::to_string(row.region), row.parameter, number(row.value),
               number(row.golden), number(row.allowed), golden_verdict_name(row.verdict)});
}

std::vector<JunitCase> golden_cases(const std::vector<GoldenRow>& rows) {
  std::vector<JunitCase> cases;
  for (const GoldenRow& row : rows) cases.push_back({name_of(row), row.why, ""});
  return cases;
}

}  // namespace hapsim
