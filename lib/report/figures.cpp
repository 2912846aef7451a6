#include "report/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/palette.h"

namespace hapsim {

Plot versions_plot(const Report& report) {
  std::vector<double> step, rmse, held_out, noise;
  for (std::size_t i = 0; i < report.versions.size(); ++i) {
    step.push_back(static_cast<double>(i));
    rmse.push_back(report.versions[i].rmse);
    held_out.push_back(report.versions[i].held_out);
    noise.push_back(report.versions[i].noise);
  }
  const auto any = [](const std::vector<double>& v) {
    return std::any_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  Plot plot(620, 220, "model version", "typical error [N]");
  plot.include_y(0);
  plot.include_x(-0.2);
  plot.include_x(static_cast<double>(step.size()) - 0.8);
  const auto series = [&](const std::vector<double>& y, const char* colour, const char* name) {
    if (!any(y)) return;
    plot.line(step, y, {colour, 2}, name);
    plot.points(step, y, {colour, 7});
  };
  if (any(noise)) plot.line(step, noise, {"#5b6876", 1.5, 1, "5 4"}, "sensor noise");
  if (std::isfinite(report.mesh_uncertainty))
    plot.line(step, std::vector<double>(step.size(), report.mesh_uncertainty),
              {"#8a6d3b", 1.5, 1, "2 3"}, "what the meshes leave open");
  series(rmse, "#d55e00", "error of the fit");
  series(held_out, "#0072b2", "error on unseen positions");
  plot.integer_x();
  return plot;
}

namespace {

// The part of the force along its own direction at the peak.
std::vector<double> along(const ReportPress& press, const std::vector<Vec3>& f) {
  std::vector<double> y;
  for (const Vec3& v : f) y.push_back(press.direction.dot(v));
  return y;
}

double squares(const ReportPress& press, const std::vector<Vec3>& simulated) {
  double sum = 0;
  for (std::size_t i = 0; i < press.measured.size(); ++i)
    sum += (press.measured[i] - simulated[i]).squaredNorm();
  return sum / static_cast<double>(std::max<std::size_t>(1, press.measured.size()));
}

}  // namespace

const ReportPress& deciding_press(const Report& report) {
  const ReportPress* worst = &report.presses.front();
  for (const ReportPress& p : report.presses)
    if (!p.simulated.empty() &&
        squares(p, p.simulated.front()) > squares(*worst, worst->simulated.front()))
      worst = &p;
  return *worst;
}

Plot deciding_plot(const Report& report) {
  const ReportPress& press = deciding_press(report);
  Plot plot(560, 320, report.time_label, "force [N]");
  plot.title(fmt::format("press {}, where the {} most", press.id,
                         press.simulated.size() > 1 ? "first model fails" : "model fails"));
  plot.include_y(0);
  plot.line(press.t, along(press, press.measured), {"#1b2733", 2.2}, "measured");
  for (const std::size_t v : {std::size_t{0}, press.simulated.size() - 1}) {
    if (v >= press.simulated.size()) break;
    plot.line(press.t, along(press, press.simulated[v]),
              {version_line_colour(report, v), 2, 1, v + 1 < press.simulated.size() ? "5 3" : ""},
              report.curves[v]);
    if (press.simulated.size() == 1) break;
  }
  return plot;
}

Plot press_plot(const Report& report, const ReportPress& press) {
  Plot plot(362, 190, report.time_label, "force [N]");
  plot.title(fmt::format("press {}, error {:.3g} N", press.id, press.rmse));
  plot.include_y(0);
  plot.line(press.t, along(press, press.measured), {"#1b2733", 1.6});
  for (std::size_t v = 0; v < press.simulated.size(); ++v)
    plot.line(press.t, along(press, press.simulated[v]), {version_line_colour(report, v), 1.5});
  return plot;
}

Plot residual_plot(const Report& report, std::size_t k) {
  double low = 0, high = 0;
  for (const ResidualPlot& r : report.residuals)
    for (const double y : r.y) low = std::min(low, y), high = std::max(high, y);
  const ResidualPlot& r = report.residuals[k];
  Plot plot(545, 300, r.x_label, "residual [N]");
  plot.include_y(low);
  plot.include_y(high);
  plot.points(r.x, r.y, {"#6f88a0", 2.6, 0.45}, "rows");
  std::vector<double> below, above;
  for (std::size_t i = 0; i < r.mean.size(); ++i) {
    below.push_back(r.mean[i] - 2 * r.error[i]);
    above.push_back(r.mean[i] + 2 * r.error[i]);
  }
  plot.band(r.centre, below, above, {"#d55e00", 0, 0.28}, "mean, 2 standard errors");
  plot.line(r.centre, r.mean, {"#d55e00", 2});
  plot.points(r.centre, r.mean, {"#d55e00", 5.5});
  return plot;
}

// The compared version is the last; it always gets the first colour.
std::string version_line_colour(const Report& report, std::size_t version) {
  return version_colour(report.curves.size() - 1 - version);
}

std::vector<std::size_t> presses_by_error(const Report& report) {
  std::vector<std::size_t> order(report.presses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return report.presses[a].rmse > report.presses[b].rmse;
  });
  return order;
}

std::vector<std::pair<std::string, std::string>> report_figures(const Report& report) {
  constexpr std::size_t kWorst = 6;
  std::vector<std::pair<std::string, std::string>> figures;
  if (report.versions.size() > 1)
    figures.emplace_back("versions.svg", versions_plot(report).file());
  for (std::size_t k = 0; k < report.residuals.size(); ++k)
    figures.emplace_back(fmt::format("residual-{}.svg", k + 1), residual_plot(report, k).file());
  const std::vector<std::size_t> order = presses_by_error(report);
  for (std::size_t i = 0; i < std::min(kWorst, order.size()); ++i) {
    const ReportPress& press = report.presses[order[i]];
    figures.emplace_back(fmt::format("press-{}.svg", press.id), press_plot(report, press).file());
  }
  return figures;
}

}  // namespace hapsim
