// The first screen: the versions of the model and the next step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html.h"
#include "report/page.h"

namespace hapsim {
namespace {

// Of what is unseen where that is known.
double error_of(const ReportVersion& v) {
  return std::isfinite(v.held_out) ? v.held_out : v.rmse;
}

// "elastic+friction" after "elastic" adds "friction".
std::string added(const std::string& before, const std::string& after) {
  return !before.empty() && after.rfind(before + "+", 0) == 0
             ? "+ " + after.substr(before.size() + 1)
             : after;
}

}  // namespace

std::string page_strip(const Report& report) {
  constexpr double kLikeNoise = 1.25;  // times the noise: green
  constexpr std::size_t kMost = 6;     // the latest
  double largest = 0;
  for (const ReportVersion& v : report.versions)
    if (std::isfinite(error_of(v))) largest = std::max(largest, error_of(v));
  if (report.versions.size() < 2 || largest <= 0) return "";
  std::string out = "<ol class='strip' aria-label='versions of the model'>";
  const std::size_t count = report.versions.size(), first = count > kMost ? count - kMost : 0;
  for (std::size_t k = first; k < count; ++k) {
    const ReportVersion& v = report.versions[k];
    const double error = error_of(v);
    const bool good = v.noise > 0 && error < kLikeNoise * v.noise;
    out += fmt::format(
        "<li{}><span>{}</span><b>{}</b><small>{}</small><i style='width:{:.0f}%'></i></li>",
        good ? " class='good'" : "",
        escape_html(added(k > first ? report.versions[k - 1].name : "", v.name)),
        std::isfinite(error) ? fmt::format("{:.3g} N", error) : "-",
        std::isfinite(v.held_out) ? "on unseen data" : "of the fit",
        std::isfinite(error) ? std::max(1.0, 100 * error / largest) : 0.0);
  }
  return out + "</ol>\n";
}

std::string page_next(const Report& report) {
  if (report.next.empty()) return "";
  if (!report.next_is_command)
    return "<div class='next'><b>Next</b><span>" + escape_html(report.next) + "</span></div>\n";
  return "<div class='next'><b>Next</b><code id='next'>" + escape_html(report.next) +
         "</code><button id='copy'>copy</button></div>\n";
}

}  // namespace hapsim
