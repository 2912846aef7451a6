#include "report/colour_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "report/axis.h"
#include "report/html.h"

namespace hapsim {
namespace {

bool two_sided(const BodyLayer& layer) {
  return layer.scale == BodyLayer::Scale::kSigned || layer.scale == BodyLayer::Scale::kFactor;
}

}  // namespace

Rgb colour_of(const BodyLayer& layer, double value) {
  if (std::isnan(value)) return kUnknownColour;
  if (layer.scale == BodyLayer::Scale::kKinds)
    return kind_colour(static_cast<std::size_t>(std::max(0.0, value)));
  return two_sided(layer) ? signed_colour(value / layer.top) : error_colour(value / layer.top);
}

double bottom_of(const BodyLayer& layer) {
  return two_sided(layer) ? -layer.top : 0;
}

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

namespace {

// Where the scale is labelled, and how.
std::vector<std::pair<double, std::string>> labels_of(const BodyLayer& layer) {
  std::vector<std::pair<double, std::string>> labels;
  if (layer.scale == BodyLayer::Scale::kFactor) {
    for (const double f :
         {0.02, 0.05, 0.1, 0.2, 0.5, 0.667, 0.8, 1.0, 1.25, 1.5, 2.0, 5.0, 10.0, 20.0, 50.0})
      // Beyond a factor of 2 either way the finer ones would crowd.
      if (layer.top < 0.8 || (f != 0.667 && f != 0.8 && f != 1.25 && f != 1.5))
        labels.emplace_back(std::log(f), fmt::format("\u00d7 {:.3g}", f));
    return labels;
  }
  const Ticks ticks = nice_ticks(bottom_of(layer), layer.top, 5, true);
  for (const double v : ticks.at) labels.emplace_back(v, ticks.label(v));
  return labels;
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
  const auto y_of = [&](double v) { return bottom - span * (v - low) / (layer.top - low); };
  std::string out =
      fmt::format("<defs><linearGradient id='scale{}' x1='0' y1='1' x2='0' y2='0'>", number);
  const std::array<Rgb, 6> stops = stops_of(layer);
  for (std::size_t i = 0; i < stops.size(); ++i)
    out += fmt::format("<stop offset='{}' stop-color='{}'/>", static_cast<double>(i) / 5,
                       css(stops[i]));
  out += fmt::format("</linearGradient></defs><path d='M0 {}h20V{}h-20z' fill='url(#scale{})'/>",
                     begin, bottom, number);
  for (const auto& [v, label] : labels_of(layer))
    if (v >= low - 1e-9 * span && v <= layer.top * (1 + 1e-9))
      out += fmt::format("<text x='28' y='{:.1f}'>{}</text>", y_of(v) + 4, label);
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

}  // namespace

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

}  // namespace hapsim
