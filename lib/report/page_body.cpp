// The body coloured by error: data for the viewer, the colour bar, or a plan of the positions.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "report/axis.h"
#include "report/html.h"
#include "report/page.h"
#include "report/palette.h"
#include "report/plot.h"

namespace hapsim {
namespace {

std::string base64(const void* data, std::size_t size) {
  static constexpr char kLetters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const unsigned a = bytes[i], b = i + 1 < size ? bytes[i + 1] : 0,
                   c = i + 2 < size ? bytes[i + 2] : 0;
    out += kLetters[a >> 2];
    out += kLetters[(a & 3) << 4 | b >> 4];
    out += i + 1 < size ? kLetters[(b & 15) << 2 | c >> 6] : '=';
    out += i + 2 < size ? kLetters[c & 63] : '=';
  }
  return out;
}

template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

// Of a value on the layer's scale; kKinds: of its number.
Rgb colour_of(const BodyLayer& layer, double value) {
  if (std::isnan(value)) return kUnknownColour;
  if (layer.scale == BodyLayer::Scale::kKinds)
    return kind_colour(static_cast<std::size_t>(std::max(0.0, value)));
  return layer.scale == BodyLayer::Scale::kSigned ? signed_colour(value / layer.top)
                                                  : error_colour(value / layer.top);
}

double bottom_of(const BodyLayer& layer) {
  return layer.scale == BodyLayer::Scale::kSigned ? -layer.top : 0;
}

// The six colours between which the viewer mixes.
std::array<Rgb, 6> stops_of(const BodyLayer& layer) {
  std::array<Rgb, 6> stops;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const double share = static_cast<double>(i) / 5;
    stops[i] = layer.scale == BodyLayer::Scale::kKinds
                   ? kind_colour(i)
                   : colour_of(layer, bottom_of(layer) + share * (layer.top - bottom_of(layer)));
  }
  return stops;
}

std::string kinds_bar(const BodyLayer& layer) {
  std::string out;
  for (int k = 0; k <= static_cast<int>(layer.top); ++k)
    out += fmt::format("<path d='M0 {0}h20v14h-20z' fill='{1}'/><text x='28' y='{2}'>{3}</text>",
                       26 + 22 * k, css(kind_colour(static_cast<std::size_t>(k))), 37 + 22 * k, k);
  return out;
}

std::string scale_bar(const BodyLayer& layer, std::size_t number, int height) {
  const double low = bottom_of(layer), bottom = height - 48, begin = 26, span = bottom - begin;
  const Ticks ticks = nice_ticks(low, layer.top, 5, true);
  const auto y_of = [&](double v) { return bottom - span * (v - low) / (layer.top - low); };
  std::string out =
      fmt::format("<defs><linearGradient id='scale{}' x1='0' y1='1' x2='0' y2='0'>", number);
  const std::array<Rgb, 6> stops = stops_of(layer);
  for (std::size_t i = 0; i < stops.size(); ++i)
    out += fmt::format("<stop offset='{}' stop-color='{}'/>", static_cast<double>(i) / 5,
                       css(stops[i]));
  out += fmt::format("</linearGradient></defs><path d='M0 {}h20V{}h-20z' fill='url(#scale{})'/>",
                     begin, bottom, number);
  for (const double v : ticks.at)
    if (v >= low - 1e-9 * span && v <= layer.top * (1 + 1e-9))
      out += fmt::format("<text x='28' y='{:.1f}'>{}</text>", y_of(v) + 4, ticks.label(v));
  if (layer.mark > 0) {
    const double y = y_of(layer.mark);
    out += fmt::format(
        "<path d='M-3 {0:.1f}h26' stroke='#1b2733' stroke-width='2'/>"
        "<text x='68' y='{1:.1f}'>{2}</text><path d='M65 {0:.1f}h-4' "
        "class='zero' stroke-dasharray='2 2'/>",
        y, y + 4, escape_html(layer.mark_name));
  }
  return out;
}

std::string colour_bar(const BodyLayer& layer, std::size_t number, int height) {
  std::string out = fmt::format(
      "<svg class='plot bar{0}'{1} viewBox='0 0 110 {2}' width='110' height='{2}' role='img' "
      "aria-label='colours of {3}'><text x='0' y='12' class='title'>{3}</text>",
      number, number == 0 ? "" : " hidden", height, escape_html(layer.title));
  out +=
      layer.scale == BodyLayer::Scale::kKinds ? kinds_bar(layer) : scale_bar(layer, number, height);
  if (layer.local)
    out +=
        fmt::format("<path d='M0 {}h20v14h-20z' fill='{}'/><text x='28' y='{}'>not measured</text>",
                    height - 24, css(kUnknownColour), height - 13);
  return out + "</svg>";
}

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
                                layer.local, script_string(layer.note));
  for (const Rgb& c : stops_of(layer)) out += fmt::format("[{},{},{}],", c[0], c[1], c[2]);
  return out + "]},";
}

std::string viewer_data(const ReportBody& body) {
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
      "<script>window.hapsimBody={{size:[{:.6g},{:.6g},{:.6g}],vertices:"
      "\"{}\",near:\"{}\",faces:\"{}\",unknown:[{},{},{}],layers:[",
      size[0], size[1], size[2], base64(place), base64(near), base64(faces), kUnknownColour[0],
      kUnknownColour[1], kUnknownColour[2]);
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
  // Below the picture, which belongs on the first screen.
  out += "</div></div><p class='note'><span id='layernote'>" +
         escape_html(body.layers.front().note) +
         "</span> Circles are the pressed positions, 1 to 3 the worst; a click shows its presses "
         "below. <span id='tip'>Drag to turn, ctrl + wheel to zoom, double click to "
         "reset; or arrow keys, + and -.</span></p>";
  return out + viewer_data(body) + "</section>\n";
}

}  // namespace hapsim
