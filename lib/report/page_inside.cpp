// The image of the stiffness inside the body: its cells for the scripts, cuts with sliders, and how
// far it can be trusted.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "report/base64.h"
#include "report/colour_bar.h"
#include "report/html.h"
#include "report/page.h"

namespace hapsim {
namespace {

constexpr int kInsideBar = 250;

// What a cell may be said of; kNothing: far from the body.
enum Cell : std::uint8_t { kNothing, kTold, kLikeTheModel, kUnresolved, kBeside = 4 };

Cell cell_of(const ReportInside& inside, std::size_t i) {
  if (std::isnan(inside.log_ratio[i])) return kNothing;
  const double half = inside.half95 * inside.log_std[i], ratio = inside.log_ratio[i];
  if (std::abs(ratio) > half) return kTold;
  const double doubled = std::log(2.0);
  return ratio - half < -doubled && ratio + half > doubled ? kUnresolved : kLikeTheModel;
}

std::uint8_t share8(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

struct Cells {
  std::vector<std::uint8_t> ratio, error, resolution, cell;
};

// Cells beside the body take what a neighbour in it has, twice over, so that the surface of the
// viewer, which does not follow the cells, lies in cells with values.
void spread_outwards(const ReportInside& inside, Cells& c) {
  const std::array<int, 3>& n = inside.count;
  for (int round = 0; round < 2; ++round) {
    const Cells before = c;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const auto index = [&](int x, int y, int z) {
            return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n[1]) +
                    static_cast<std::size_t>(y)) *
                       static_cast<std::size_t>(n[0]) +
                   static_cast<std::size_t>(x);
          };
          const std::size_t at = index(i, j, k);
          if (before.cell[at] != kNothing) continue;
          for (const auto& [dx, dy, dz] :
               {std::array{0, 0, -1}, std::array{0, 0, 1}, std::array{0, -1, 0},
                std::array{0, 1, 0}, std::array{-1, 0, 0}, std::array{1, 0, 0}}) {
            const int x = i + dx, y = j + dy, z = k + dz;
            if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) continue;
            const std::size_t from = index(x, y, z);
            if (before.cell[from] == kNothing) continue;
            c.ratio[at] = before.ratio[from];
            c.error[at] = before.error[from];
            c.cell[at] = static_cast<std::uint8_t>((before.cell[from] & 3) | kBeside);
            break;
          }
        }
  }
}

std::string css_list(const std::array<Rgb, 6>& stops) {
  std::string out = "[";
  for (const Rgb& c : stops) out += fmt::format("[{},{},{}],", c[0], c[1], c[2]);
  return out + "]";
}

}  // namespace

std::string inside_data(const Report& report) {
  const ReportInside& inside = report.inside;
  if (inside.size() == 0) return "";
  const BodyLayer& ratio = report.body.layers[inside.ratio_layer];
  const BodyLayer& error = report.body.layers[inside.error_layer];
  Cells cells;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const Cell cell = cell_of(inside, i);
    const bool told = cell != kNothing;
    cells.cell.push_back(cell);
    cells.ratio.push_back(told ? share8(0.5 + 0.5 * inside.log_ratio[i] / ratio.top) : 0);
    cells.error.push_back(told ? share8(100 * inside.log_std[i] / error.top) : 0);
    cells.resolution.push_back(
        told ? static_cast<std::uint8_t>(std::min(255.0, std::round(1e3 * inside.resolution[i])))
             : 0);
  }
  spread_outwards(inside, cells);
  std::string out = fmt::format(
      "<script>window.hapsimInside={{count:[{},{},{}],low:[{:.6g},{:.6g},{:.6g}],cell:{:.6g},"
      "ratio:\"{}\",error:\"{}\",resolution:\"{}\",state:\"{}\",top:{:.6g},most:{:.6g},"
      "half95:{},above:{:.6g},unknown:[{},{},{}],ratioStops:{},errorStops:{},presses:[",
      inside.count[0], inside.count[1], inside.count[2], inside.low[0], inside.low[1],
      inside.low[2], inside.cell, base64(cells.ratio), base64(cells.error),
      base64(cells.resolution), base64(cells.cell), ratio.top, error.top, inside.half95, inside.top,
      kUnknownColour[0], kUnknownColour[1], kUnknownColour[2], css_list(stops_of(ratio)),
      css_list(stops_of(error)));
  for (const Vec3& p : report.body.positions)
    out += fmt::format("[{:.5f},{:.5f},{:.5f}],", p[0], p[1], p[2]);
  return out + "]};</script>";
}

std::string page_inside(const Report& report) {
  const ReportInside& inside = report.inside;
  if (inside.size() == 0) return "";
  std::string out = "<section id='inside'><h2>The image of what is inside</h2>";
  for (const std::string& words : inside.words) out += "<p>" + escape_html(words) + "</p>";
  out +=
      "<div class='key'><span><i class='swatch told'></i>stiffer or softer than the model, by more "
      "than the 95 % interval</span><span><i class='swatch like'></i>pale: 1 lies within the 95 % "
      "interval, no difference is seen</span><span><i class='swatch open'></i>hatched: half and "
      "double both lie within it, these presses do not tell</span><span><i class='swatch "
      "press'></i>pressed places</span></div>";
  const auto cut = [&](const char* id, const std::string& choice, const char* label) {
    out += fmt::format(
        "<div class='picker'>{}<label>{} <input type='range' id='{}-at' min='0' max='1' step='1' "
        "value='0'></label> <output id='{}-out' for='{}-at'></output></div><div class='cut'>"
        "<figure><figcaption>stiffness, times the model's</figcaption><canvas id='{}-ratio' "
        "role='img' aria-label='stiffness over the model&#39;s in the cut'></canvas></figure>"
        "<figure><figcaption>its standard error</figcaption><canvas id='{}-error' role='img' "
        "aria-label='standard error of the stiffness in the cut'></canvas></figure></div>",
        choice, label, id, id, id, id, id);
  };
  out += "<div class='cuts'><div><h3>Horizontal cut</h3>";
  cut("flat", "", "depth");
  out += "<h3>Upright cut</h3>";
  cut("upright",
      "<label>across <select id='upright-across'><option value='1'>y</option><option "
      "value='0'>x</option></select></label> ",
      "at");
  out += "</div><div class='bars'>";
  // Told from the bars of the viewer, which hides all but one.
  for (const std::size_t layer : {inside.ratio_layer, inside.error_layer}) {
    std::string bar = colour_bar(report.body.layers[layer], 100 + layer, kInsideBar);
    bar.replace(bar.find(" hidden"), 7, "");
    out += bar;
  }
  return out +
         "</div></div><p class='readout' id='inside-readout'>Point at a cut for its values.</p>"
         "</section>\n";
}

}  // namespace hapsim
