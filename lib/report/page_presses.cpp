// Force over time, press by press: small plots of the worst and best, data for the chosen one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figures.h"
#include "report/html.h"
#include "report/page.h"

namespace hapsim {
namespace {

constexpr std::size_t kWorst = 6;
constexpr std::size_t kBest = 2;

std::string small_plot(const Report& report, std::size_t index) {
  const ReportPress& press = report.presses[index];
  return fmt::format("<figure data-press='{}'>", index) + press_plot(report, press).svg() +
         "<div class='note'>" + escape_html(press.place) +
         fmt::format(" <button title='all of press {}, below'>all of it</button></div></figure>",
                     press.id);
}

// Forces as integers of a common unit: short, and exact to a 20,000th of the largest.
std::string press_data(const Report& report) {
  double largest = 0;
  for (const ReportPress& p : report.presses) {
    for (const Vec3& f : p.measured) largest = std::max(largest, f.cwiseAbs().maxCoeff());
    for (const auto& version : p.simulated)
      for (const Vec3& f : version) largest = std::max(largest, f.cwiseAbs().maxCoeff());
  }
  const double unit = largest > 0 ? largest / 20000 : 1;
  const auto components = [&](const std::vector<Vec3>& f) {
    std::string out = "[";
    for (int k = 0; k < 3; ++k) {
      out += k == 0 ? "[" : ",[";
      for (std::size_t i = 0; i < f.size(); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : ",", std::lround(f[i][k] / unit));
      out += "]";
    }
    return out + "]";
  };
  std::string out = fmt::format("<script>window.hapsimPresses={{unit:{:.9g},time:{},names:[", unit,
                                script_string(report.time_label));
  for (const std::string& name : report.curves) out += script_string(name) + ",";
  out += "],colours:[";
  for (std::size_t v = 0; v < report.curves.size(); ++v)
    out += script_string(version_line_colour(report, v)) + ",";
  out += "],presses:[\n";
  for (const ReportPress& p : report.presses) {
    out += fmt::format("{{p:{},t:[", p.position);
    for (std::size_t i = 0; i < p.t.size(); ++i)
      out += fmt::format("{}{:.6g}", i == 0 ? "" : ",", p.t[i]);
    out += "],m:" + components(p.measured) + ",s:[";
    for (const auto& version : p.simulated) out += components(version) + ",";
    out += "]},\n";
  }
  return out + "]};</script>";
}

}  // namespace

std::string page_presses(const Report& report) {
  if (report.presses.empty()) return "";
  std::string out =
      "<section><h2>Force over time, measured and simulated</h2><div class='key'>"
      "<span><i style='border-color:#1b2733'></i>measured</span>";
  for (std::size_t v = 0; v < report.curves.size(); ++v)
    out +=
        fmt::format("<span><i style='border-color:{}'></i>{}{}</span>",
                    version_line_colour(report, v), escape_html(report.curves[v]),
                    report.curves.size() > 1 && v + 1 == report.curves.size() ? " (compared)" : "");
  out += "</div><p class='note'>The part of the force along its own direction at the peak. " +
         escape_html(report.presses_note) + "</p>";
  const std::vector<std::size_t> order = presses_by_error(report);
  const std::size_t worst = std::min(kWorst, order.size());
  out += fmt::format("<h3>{} largest errors</h3><div class='multiples'>", worst);
  for (std::size_t i = 0; i < worst; ++i) out += small_plot(report, order[i]);
  out += "</div>";
  if (order.size() > worst) {
    const std::size_t best = std::min(kBest, order.size() - worst);
    out += fmt::format("<h3>{} smallest errors</h3><div class='multiples'>", best);
    for (std::size_t i = order.size() - best; i < order.size(); ++i)
      out += small_plot(report, order[i]);
    out += "</div>";
  }
  out +=
      "<div class='picker'><label for='pick'><b>Any press</b></label><button id='before' "
      "title='previous' aria-label='previous press'>&#8592;</button><select id='pick'>";
  for (std::size_t i = 0; i < report.presses.size(); ++i) {
    const ReportPress& p = report.presses[i];
    out += fmt::format("<option value='{}'{}>press {}, error {:.3g} N, {}</option>", i,
                       i == order[0] ? " selected" : "", p.id, p.rmse, escape_html(p.place));
  }
  out +=
      "</select><button id='after' title='next' aria-label='next press'>&#8594;</button></div><div "
      "class='readout' "
      "id='readout'></div><div id='press'></div>";
  return out + press_data(report) + "</section>\n";
}

}  // namespace hapsim
