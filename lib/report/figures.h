// The plots of a report, each by itself: for the page, and as files for papers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/plot.h"
#include "report/report.h"

namespace hapsim {

Plot versions_plot(const Report& report);  // errors by model version; report.versions not empty
// The press that the first version fails most at; report.presses not empty.
const ReportPress& deciding_press(const Report& report);
Plot deciding_plot(const Report& report);  // of it: measured, before and after
Plot press_plot(const Report& report, const ReportPress& press);  // along the force at its peak
// Residual `k` of the report; all share one force scale.
Plot residual_plot(const Report& report, std::size_t k);
std::string version_line_colour(const Report& report, std::size_t version);
std::vector<std::size_t> presses_by_error(const Report& report);  // largest first

// File names and stand-alone SVG text: versions.svg, residual-1.svg ..., press-ID.svg of the six
// worst presses.
std::vector<std::pair<std::string, std::string>> report_figures(const Report& report);

}  // namespace hapsim
