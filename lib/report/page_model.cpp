// What the model has inside: the curve that it learned, and cuts through its stiffness.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "report/html.h"
#include "report/page.h"
#include "report/palette.h"
#include "report/plot.h"

namespace hapsim {
namespace {

// Of all slices: the least and the largest modulus [Pa].
struct Range {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::string colour(double modulus) const {
    const double width = std::log(most / least);
    return css(error_colour(width > 0 ? std::log(modulus / least) / width : 0));
  }
};

// Cells of a row that are alike are one rectangle.
std::string slice_svg(const ReportSlice& slice, const Range& range) {
  constexpr double kSide = 4, kLeft = 34, kBelow = 30;  // [px]: of a cell, room for the axes
  const int rows = static_cast<int>(slice.modulus.size()) / std::max(1, slice.columns);
  const double width = kLeft + kSide * slice.columns, height = kSide * rows + kBelow;
  std::string svg = fmt::format(
      "<svg class='plot' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' role='img' "
      "aria-label='{2}'>",
      width + 8, height, escape_html("stiffness in the cut " + slice.title));
  for (int row = 0; row < rows; ++row)
    for (int begin = 0, end = 0; begin < slice.columns; begin = end) {
      const auto at = [&](int column) {
        return slice.modulus[static_cast<std::size_t>(row * slice.columns + column)];
      };
      for (end = begin + 1; end < slice.columns && at(end) == at(begin);) ++end;
      if (at(begin) == 0) continue;
      svg += fmt::format("<rect x='{:.0f}' y='{:.0f}' width='{:.0f}' height='{:.0f}' fill='{}'/>",
                         kLeft + kSide * begin, kSide * (rows - 1 - row), kSide * (end - begin),
                         kSide, range.colour(at(begin)));
    }
  const auto text = [&](double x, double y, const char* anchor, const std::string& words) {
    svg += fmt::format("<text x='{:.0f}' y='{:.0f}' text-anchor='{}' class='name'>{}</text>", x, y,
                       anchor, escape_html(words));
  };
  const double right = 1e3 * (slice.left + slice.cell * slice.columns),
               top = 1e3 * (slice.bottom + slice.cell * rows);
  text(kLeft, height - 16, "start", fmt::format("{:.0f}", 1e3 * slice.left));
  text(width, height - 16, "end", fmt::format("{:.0f}", right));
  text((kLeft + width) / 2, height - 4, "middle", slice.right);
  text(kLeft - 4, height - kBelow, "end", fmt::format("{:.0f}", 1e3 * slice.bottom));
  text(kLeft - 4, 10, "end", fmt::format("{:.0f}", top));
  text(kLeft - 4, (height - kBelow) / 2, "end", slice.up.substr(0, 1));
  return svg + "</svg>";
}

}  // namespace

std::string page_learned(const Report& report) {
  std::string out;
  for (const ReportCurve& c : report.learned) {
    Plot plot(560, 280, c.x_label, c.y_label);
    plot.title(c.title);
    plot.band(c.x, c.low, c.high, {.colour = "#0072b2", .opacity = 0.2});
    plot.line(c.x, c.middle, {.colour = "#0072b2", .width = 2});
    plot.level(1, {.colour = "#5b6770", .width = 1, .dash = "4 3"}, "the model without it");
    out += "<figure>" + plot.svg() + "<div class='note'>" + escape_html(c.note) + "</div></figure>";
  }
  return out.empty() ? "" : "<section><h2>What was learned</h2>" + out + "</section>\n";
}

std::string page_slices(const Report& report) {
  if (report.slices.empty()) return "";
  Range range;
  std::set<double> moduli;
  for (const ReportSlice& slice : report.slices)
    for (const double E : slice.modulus)
      if (E > 0) {
        range.least = std::min(range.least, E);
        range.most = std::max(range.most, E);
        moduli.insert(E);
      }
  std::string out =
      "<section><h2>Inside the body</h2><p class='note'>The model's modulus in three cuts through "
      "what differs most; a skin is drawn all around, on what holds the body as well.</p>"
      "<div class='multiples'>";
  for (const ReportSlice& slice : report.slices)
    out += "<figure>" + slice_svg(slice, range) + "<figcaption>" + escape_html(slice.title) +
           "</figcaption></figure>";
  out += "</div><div class='key'>";
  constexpr std::size_t kMost = 8;  // named; of more the least and the largest
  if (moduli.size() > kMost) moduli = {range.least, range.most};
  for (const double E : moduli)
    out += fmt::format(
        "<span><i style='border-color:{};border-top-width:10px'></i>E = {:.3g} kPa</span>",
        range.colour(E), 1e-3 * E);
  return out + "</div></section>\n";
}

}  // namespace hapsim
