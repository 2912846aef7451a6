// Tables: model versions, diagnosis, breakdowns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/number.h"
#include "report/figures.h"
#include "report/html.h"
#include "report/page.h"

namespace hapsim {
namespace {

// Wide tables scroll, by keys too.
constexpr const char* kScroll = "<div class='scroll' tabindex='0'>";

// Numbers stand at the right, under each other.
bool numeric(const std::string& cell) {
  double value = 0;
  const std::string first = cell.substr(0, cell.find_first_of(" %"));
  return parse_number(first, value);
}

std::string table(const ReportTable& t, const std::string& caption) {
  std::string out = kScroll + std::string("<table>");
  if (!caption.empty()) out += "<caption>" + escape_html(caption) + "</caption>";
  std::vector<bool> right(t.columns.size(), false);
  for (std::size_t c = 0; c < t.columns.size(); ++c) {
    std::size_t numbers = 0, filled = 0;
    for (const auto& row : t.rows) {
      filled += !row[c].empty();
      numbers += numeric(row[c]);
    }
    right[c] = c > 0 && filled > 0 && 2 * numbers > filled;
  }
  out += "<thead><tr>";
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    out += fmt::format("<th{}>{}</th>", right[c] ? " class='n'" : "", escape_html(t.columns[c]));
  if (!t.bar.empty()) out += "<th><span class='unseen'>error as a bar</span></th>";
  out += "</tr></thead><tbody>";
  for (std::size_t r = 0; r < t.rows.size(); ++r) {
    out += "<tr>";
    for (std::size_t c = 0; c < t.columns.size(); ++c)
      out += fmt::format("<td{}>{}</td>", right[c] ? " class='n'" : "", escape_html(t.rows[r][c]));
    if (!t.bar.empty())
      out += fmt::format("<td><span class='bar' style='width:{:.0f}px'></span></td>",
                         46 * std::clamp(t.bar[r], 0.0, 1.0));
    out += "</tr>";
  }
  return out + "</tbody></table></div>";
}

}  // namespace

std::string page_versions(const Report& report) {
  if (report.history.rows.empty()) return "";
  std::string out = "<section><h2>Model versions and their errors</h2>" + table(report.history, "");
  const bool any = std::any_of(report.versions.begin(), report.versions.end(),
                               [](const ReportVersion& v) { return std::isfinite(v.rmse); });
  if (report.versions.size() < 2 || !any) return out + "</section>\n";
  return out + "<figure>" + versions_plot(report).svg() + "</figure></section>\n";
}

std::string page_parameters(const Report& report) {
  if (report.parameters.rows.empty()) return "";
  return "<section><h2>Parameters of the model</h2><p class='note'>" +
         escape_html(report.parameters.caption) + "</p>" + table(report.parameters, "") +
         "</section>\n";
}

namespace {

std::string one_effect(const DiagnosisRow& row) {
  // A verdict is a class name only when it is one of ours: letters, no more.
  const bool word = std::all_of(row.verdict.begin(), row.verdict.end(),
                                [](char c) { return c >= 'a' && c <= 'z'; });
  std::string out = fmt::format(
      "<div class='candidate'><div><h3>{}{}</h3><span class='tag {}'>{}</span></div>"
      "<div><div class='facts'>",
      row.rank.empty() || row.rank == "0" ? "" : escape_html(row.rank) + ". ",
      escape_html(row.effect), word ? row.verdict : "", escape_html(row.verdict));
  for (const auto& [name, text] : row.facts)
    out += fmt::format("<span><small>{}</small>{}</span>", escape_html(name), escape_html(text));
  out += "</div>";
  for (const auto& [name, text] : row.notes)
    out += fmt::format("<div class='long'><small>{}</small>{}</div>", escape_html(name),
                       escape_html(text));
  if (!row.command.empty()) out += "<pre>" + escape_html(row.command) + "</pre>";
  return out + "</div></div>";
}

// What was found is open to see; what was tried in vain opens on a click.
std::string one_diagnosis(const ReportDiagnosis& diagnosis) {
  std::string found, vain, names;
  for (const DiagnosisRow& row : diagnosis.rows) {
    if (row.verdict == "absent" || row.verdict == "not testable") {
      vain += one_effect(row);
      names += (names.empty() ? "" : ", ") + row.effect +
               (row.verdict == "absent" ? "" : " (not testable)");
    } else {
      found += one_effect(row);
    }
  }
  if (!vain.empty())
    vain = "<details><summary>Tried and not needed: " + escape_html(names) + "</summary>" + vain +
           "</details>";
  return "<section><h2>Which physical effect is missing" +
         (diagnosis.version.empty() ? "" : ": " + escape_html(diagnosis.version)) + "</h2>" +
         found + vain + "</section>\n";
}

}  // namespace

std::string page_diagnosis(const Report& report) {
  std::string out;
  for (const ReportDiagnosis& diagnosis : report.diagnoses) out += one_diagnosis(diagnosis);
  return out;
}

std::string page_residuals(const Report& report) {
  if (report.residuals.empty()) return "";
  std::string out =
      "<section><h2>Residual along the surface normal</h2><p class='note'>Measured minus "
      "simulated; "
      "above zero the body pushes harder than the model. Points: rows (thinned). Line and band: "
      "mean of a group and two standard errors to each side, from press to press. All four share "
      "one force scale.</p><div class='two'>";
  for (std::size_t k = 0; k < report.residuals.size(); ++k)
    out += "<figure>" + residual_plot(report, k).svg() + "</figure>";
  return out + "</div></section>\n";
}

std::string page_tables(const Report& report) {
  if (report.tables.empty()) return "";
  std::string out = "<section><h2>Where the error is</h2>";
  for (std::size_t i = 0; i < report.tables.size(); ++i) {
    out += table(report.tables[i], report.tables[i].caption);
    if (i == 0) out += "<div class='tables'>";
  }
  return out + "</div></section>\n";
}

}  // namespace hapsim
