// The body coloured by error: data for the viewer, the colour bar, or a plan of the positions.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/base64.h"
#include "report/colour_bar.h"
#include "report/html.h"
#include "report/page.h"
#include "report/palette.h"
#include "report/plot.h"

namespace hapsim {
namespace {

// Position 1 is the worst.
std::vector<int> ranks(const std::vector<double>& error) {
  std::vector<int> order(error.size()), rank(error.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return error[a] > error[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i) + 1;
  return rank;
}

// Unit normal of the surface at the vertex nearest to a point; zero without faces.
Vec3 surface_normal(const ReportBody& body, const Vec3& p) {
  int nearest = 0;
  for (std::size_t i = 1; i < body.vertices.size(); ++i)
    if ((body.vertices[i] - p).squaredNorm() < (body.vertices[nearest] - p).squaredNorm())
      nearest = static_cast<int>(i);
  Vec3 sum = Vec3::Zero();
  for (const auto& f : body.faces)
    if (f[0] == nearest || f[1] == nearest || f[2] == nearest)
      sum += (body.vertices[f[1]] - body.vertices[f[0]])
                 .cross(body.vertices[f[2]] - body.vertices[f[0]]);
  return sum.stableNormalized();
}

std::uint16_t share16(double x) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(x, 0.0, 1.0)));
}

std::string layer_data(const BodyLayer& layer) {
  std::vector<std::uint16_t> level;
  const double low = bottom_of(layer);
  const bool kinds = layer.scale == BodyLayer::Scale::kKinds;
  for (const double v : layer.value)
    level.push_back(share16(kinds ? std::fmod(v, 6) / 5 : (v - low) / (layer.top - low)));
  std::string out = fmt::format("{{level:\"{}\",local:{},note:{},stops:[", base64(level),
                                layer.local && !layer.value.empty(), script_string(layer.note));
  for (const Rgb& c : stops_of(layer)) out += fmt::format("[{},{},{}],", c[0], c[1], c[2]);
  return out + "]},";
}

std::string viewer_data(const ReportBody& body, const ReportInside& inside) {
  Vec3 low = body.vertices.front(), high = low;
  for (const Vec3& v : body.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  const Vec3 size = (high - low).cwiseMax(1e-9), middle = 0.5 * (low + high);
  std::vector<std::uint16_t> place, near;
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      place.push_back(static_cast<std::uint16_t>(
          std::lround(65535 * (body.vertices[i][k] - low[k]) / size[k])));
    near.push_back(share16(1 - 0.5 * body.distance[i] / body.reach));  // half at the reach
  }
  std::vector<std::uint32_t> faces;
  for (const auto& f : body.faces)
    for (const int v : f) faces.push_back(static_cast<std::uint32_t>(v));

  std::string out = fmt::format(
      "<script>window.hapsimBody={{size:[{:.6g},{:.6g},{:.6g}],middle:[{:.6g},{:.6g},{:.6g}],"
      "vertices:"
      "\"{}\",near:\"{}\",faces:\"{}\",unknown:[{},{},{}],ratioLayer:{},errorLayer:{},layers:[",
      size[0], size[1], size[2], middle[0], middle[1], middle[2], base64(place), base64(near),
      base64(faces), kUnknownColour[0], kUnknownColour[1], kUnknownColour[2],
      inside.size() > 0 ? int(inside.ratio_layer) : -1,
      inside.size() > 0 ? int(inside.error_layer) : -1);
  for (const BodyLayer& layer : body.layers) out += layer_data(layer);
  out += "],positions:[";
  const std::vector<int> rank = ranks(body.layers.front().at_position);
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 p = body.positions[i] - middle, n = surface_normal(body, body.positions[i]);
    const Vec3 mm = 1e3 * body.positions[i];
    std::string label =
        fmt::format("position ({:.1f}, {:.1f}, {:.1f}) mm, number {} from the worst", mm[0], mm[1],
                    mm[2], rank[i]);
    out +=
        fmt::format("{{at:[{:.5f},{:.5f},{:.5f}],normal:[{:.3f},{:.3f},{:.3f}],rank:{},colours:[",
                    p[0], p[1], p[2], n[0], n[1], n[2], rank[i]);
    for (const BodyLayer& layer : body.layers) {
      out += "\"" + css(colour_of(layer, layer.at_position[i])) + "\",";
      label += "; " + layer.at_position_text[i];
    }
    out += "],label:" + script_string(label) + "},";
  }
  return out + "]};</script>";
}

// Seen from above, x to the right and y up, to one scale.
std::string plan(const ReportBody& body) {
  Vec3 low = body.positions.front(), high = low;
  for (const Vec3& p : body.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 span = (high - low).cwiseMax(1e-3);
  const double scale = std::min(560 / span[0], 380 / span[1]);
  const BodyLayer& layer = body.layers.front();
  Plot plot(static_cast<int>(span[0] * 1.1 * scale) + 70,
            static_cast<int>(span[1] * 1.1 * scale) + 50, "x [mm]", "y [mm]");
  for (int side : {-1, 1}) {
    plot.include_x(1e3 * (0.5 * (low[0] + high[0]) + side * 0.55 * span[0]));
    plot.include_y(1e3 * (0.5 * (low[1] + high[1]) + side * 0.55 * span[1]));
  }
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const std::vector<double> x{1e3 * body.positions[i][0]}, y{1e3 * body.positions[i][1]};
    plot.points(x, y, {"#1b2733", 19});
    plot.points(x, y, {css(colour_of(layer, layer.at_position[i])), 16});
  }
  return "<figure>" + plot.svg() + "</figure>";
}

constexpr int kBarHeight = 330;  // as the stage's in report.css

}  // namespace

std::string page_body(const Report& report) {
  const ReportBody& body = report.body;
  if (body.positions.empty() || body.layers.empty()) return "";
  std::string out = "<section><h2>The body, coloured by error</h2>";
  if (body.faces.empty())
    return out +
           "<p class='note'>Pressed positions seen from above, coloured by the typical error of "
           "their presses. Give the body with --body for its surface.</p><div class='body3d "
           "plan'>" +
           plan(body) + colour_bar(body.layers.front(), 0, 400) + "</div></section>\n";
  if (body.layers.size() > 1) {
    out += "<div class='layers' id='layers'>colour by ";
    for (std::size_t k = 0; k < body.layers.size(); ++k)
      out += fmt::format("<button data-layer='{}' aria-pressed='{}'{}>{}</button>", k, k == 0,
                         k == 0 ? " class='on'" : "", escape_html(body.layers[k].name));
    out += "</div>";
  }
  out +=
      "<div class='body3d'><div class='stage' id='stage' tabindex='0' "
      "role='application' aria-label='The body, coloured by error: arrow keys turn it, plus and "
      "minus zoom, Home resets, N goes to the next pressed position'><canvas class='surface' "
      "aria-hidden='true'></canvas><canvas class='marks' aria-hidden='true'></canvas></div><div "
      "id='bars'>";
  for (std::size_t k = 0; k < body.layers.size(); ++k)
    out += colour_bar(body.layers[k], k, kBarHeight);
  out += "</div></div>";
  if (report.inside.size() > 0)
    out +=
        "<div class='layers'><label>cut open across <select id='cut-axis'><option "
        "value='-1'>nothing</option><option value='0'>x</option><option value='1'>y</option>"
        "<option value='2'>z</option></select></label> <label>at <input type='range' id='cut-at' "
        "min='0' max='200' value='100'></label> <output id='cut-out' "
        "for='cut-at'></output></div>";
  // Below the picture, which belongs on the first screen.
  out += "<p class='note'><span id='layernote'>" + escape_html(body.layers.front().note) +
         "</span> Circles are the pressed positions, 1 to 3 the worst; a click shows its presses "
         "below. <span id='tip'>Drag to turn, ctrl + wheel to zoom, double click to "
         "reset; or arrow keys, + and -.</span></p>";
  return out + viewer_data(body, report.inside) + "</section>\n";
}

}  // namespace hapsim
