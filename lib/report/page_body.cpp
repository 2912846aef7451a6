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

double top_of_scale(const ReportBody& body) {
  double top = 2 * body.noise;  // an error as small as the noise must not look alarming
  for (const double e : body.position_error) top = std::max(top, e);
  return nice_ticks(0, top > 0 ? top : 1, 5, true).upper;
}

std::string colour_bar(const ReportBody& body, double top, int height) {
  const Ticks ticks = nice_ticks(0, top, 5, true);
  const double bottom = height - 48, begin = 26, span = bottom - begin;
  std::string out = fmt::format(
      "<svg class='plot' viewBox='0 0 96 {0}' width='96' height='{0}'>"
      "<text x='0' y='12' class='title'>error [N]</text>",
      height);
  out += "<defs><linearGradient id='errors' x1='0' y1='1' x2='0' y2='0'>";
  for (int i = 0; i < 6; ++i)
    out += fmt::format("<stop offset='{}' stop-color='{}'/>", i / 5.0, css(error_colour(i / 5.0)));
  out += fmt::format("</linearGradient></defs><path d='M0 {}h20V{}h-20z' fill='url(#errors)'/>",
                     begin, bottom);
  for (const double v : ticks.at)
    out += fmt::format("<text x='28' y='{:.1f}'>{}</text>", bottom - span * v / top + 4,
                       ticks.label(v));
  if (body.noise > 0) {
    const double y = bottom - span * body.noise / top;
    out += fmt::format(
        "<path d='M-3 {0:.1f}h26' stroke='#1b2733' stroke-width='2'/>"
        "<text x='60' y='{1:.1f}'>noise</text><path d='M57 {0:.1f}h-4' "
        "class='zero' stroke-dasharray='2 2'/>",
        y, y + 4);
  }
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

std::string viewer_data(const ReportBody& body, double top) {
  Vec3 low = body.vertices.front(), high = low;
  for (const Vec3& v : body.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  const Vec3 size = (high - low).cwiseMax(1e-9), middle = 0.5 * (low + high);
  std::vector<std::uint16_t> place, level, near;
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      place.push_back(static_cast<std::uint16_t>(
          std::lround(65535 * (body.vertices[i][k] - low[k]) / size[k])));
    const auto share = [](double x) {
      return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(x, 0.0, 1.0)));
    };
    level.push_back(share(body.error[i] / top));
    near.push_back(share(1 - 0.5 * body.distance[i] / body.reach));  // half at the reach
  }
  std::vector<std::uint32_t> faces;
  for (const auto& f : body.faces)
    for (const int v : f) faces.push_back(static_cast<std::uint32_t>(v));

  std::string out = fmt::format(
      "<script>window.hapsimBody={{size:[{:.6g},{:.6g},{:.6g}],vertices:"
      "\"{}\",error:\"{}\",near:\"{}\",faces:\"{}\",stops:[",
      size[0], size[1], size[2], base64(place), base64(level), base64(near), base64(faces));
  for (int i = 0; i < 6; ++i) {
    const Rgb c = error_colour(i / 5.0);
    out += fmt::format("[{},{},{}],", c[0], c[1], c[2]);
  }
  out += fmt::format("],unknown:[{},{},{}],positions:[", kUnknownColour[0], kUnknownColour[1],
                     kUnknownColour[2]);
  const std::vector<int> rank = ranks(body.position_error);
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 p = body.positions[i] - middle, n = surface_normal(body, body.positions[i]);
    const Vec3 mm = 1e3 * body.positions[i];
    out += fmt::format(
        "{{at:[{:.5f},{:.5f},{:.5f}],normal:[{:.3f},{:.3f},{:.3f}],rank:{},colour:"
        "\"{}\",label:\"position ({:.1f}, {:.1f}, {:.1f}) mm: error {:.3g} N, number "
        "{} from the worst\"}},",
        p[0], p[1], p[2], n[0], n[1], n[2], rank[i],
        css(error_colour(body.position_error[i] / top)), mm[0], mm[1], mm[2],
        body.position_error[i], rank[i]);
  }
  return out + "]};</script>";
}

// Seen from above, x to the right and y up, to one scale.
std::string plan(const ReportBody& body, double top) {
  Vec3 low = body.positions.front(), high = low;
  for (const Vec3& p : body.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 span = (high - low).cwiseMax(1e-3);
  const double scale = std::min(560 / span[0], 380 / span[1]);
  Plot plot(static_cast<int>(span[0] * 1.1 * scale) + 70,
            static_cast<int>(span[1] * 1.1 * scale) + 50, "x [mm]", "y [mm]");
  for (int side : {-1, 1}) {
    plot.include_x(1e3 * (0.5 * (low[0] + high[0]) + side * 0.55 * span[0]));
    plot.include_y(1e3 * (0.5 * (low[1] + high[1]) + side * 0.55 * span[1]));
  }
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const std::vector<double> x{1e3 * body.positions[i][0]}, y{1e3 * body.positions[i][1]};
    plot.points(x, y, {"#1b2733", 19});
    plot.points(x, y, {css(error_colour(body.position_error[i] / top)), 16});
  }
  return "<figure>" + plot.svg() + "</figure>";
}

}  // namespace

std::string page_body(const Report& report) {
  const ReportBody& body = report.body;
  if (body.positions.empty()) return "";
  const double top = top_of_scale(body);
  std::string out = "<section><h2>The body, coloured by error</h2>";
  if (body.faces.empty())
    return out +
           "<p class='note'>Pressed positions seen from above, coloured by the typical error of "
           "their presses. Give the body with --body for its surface.</p><div class='body3d "
           "plan'>" +
           plan(body, top) + colour_bar(body, top, 400) + "</div></section>\n";
  out +=
      "<p class='note'>Typical error (rmse) of the presses near by; grey where nothing was pressed "
      "near. Circles are the pressed positions, 1 to 3 the worst. <span id='tip'>Drag to turn, "
      "ctrl + wheel to zoom, double click to reset.</span></p><div class='body3d'><div "
      "class='stage' "
      "id='stage'><canvas class='surface'></canvas><canvas class='marks'></canvas></div>";
  return out + colour_bar(body, top, 480) + "</div>" + viewer_data(body, top) + "</section>\n";
}

}  // namespace hapsim
