#include "report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html.h"

namespace hapsim {
namespace {

constexpr double kCharacter = 6.4;  // width of a label's character at 11 px

// "12.3", without a trailing ".0": pixels need no more.
std::string px(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

}  // namespace

// Where the data area lies and how values become pixels.
struct Plot::Frame {
  Ticks x, y;
  double left, right, top, bottom;
  double px_x(double v) const {
    return left + (v - x.lower) / (x.upper - x.lower) * (right - left);
  }
  double px_y(double v) const {
    return bottom - (v - y.lower) / (y.upper - y.lower) * (bottom - top);
  }
  std::string at(double vx, double vy) const { return px(px_x(vx)) + " " + px(px_y(vy)); }
};

Plot::Plot(int width, int height, std::string x_label, std::string y_label)
    : width_(width), height_(height), x_label_(std::move(x_label)), y_label_(std::move(y_label)) {}

void Plot::include_x(double x) {
  if (!std::isfinite(x)) return;
  x_low_ = std::min(x_low_, x);
  x_high_ = std::max(x_high_, x);
}

void Plot::include_y(double y) {
  if (!std::isfinite(y)) return;
  y_low_ = std::min(y_low_, y);
  y_high_ = std::max(y_high_, y);
}

void Plot::line(const std::vector<double>& x, const std::vector<double>& y, const PlotStyle& style,
                const std::string& legend) {
  for (const double v : x) include_x(v);
  for (const double v : y) include_y(v);
  elements_.push_back({Element::Kind::kLine, x, y, {}, style, legend});
}

void Plot::points(const std::vector<double>& x, const std::vector<double>& y,
                  const PlotStyle& style, const std::string& legend) {
  line(x, y, style, legend);
  elements_.back().kind = Element::Kind::kPoints;
}

void Plot::band(const std::vector<double>& x, const std::vector<double>& low,
                const std::vector<double>& high, const PlotStyle& style,
                const std::string& legend) {
  line(x, low, style, legend);
  for (const double v : high) include_y(v);
  elements_.back().kind = Element::Kind::kBand;
  elements_.back().high = high;
}

void Plot::level(double y, const PlotStyle& style, const std::string& legend) {
  include_y(y);
  elements_.push_back({Element::Kind::kLevel, {}, {y}, {}, style, legend});
}

std::string Plot::draw(const Element& e, const Frame& frame) const {
  std::string path;
  const std::string stroke =
      fmt::format("stroke='{}' stroke-width='{}' stroke-opacity='{}'", escape_html(e.style.colour),
                  e.style.width, e.style.opacity);
  if (e.kind == Element::Kind::kLevel) {
    const std::string y = px(frame.px_y(e.y[0]));
    return fmt::format("<path d='M{} {}H{}' {} stroke-dasharray='{}' fill='none'/>", px(frame.left),
                       y, px(frame.right), stroke, e.style.dash);
  }
  if (e.kind == Element::Kind::kBand) {
    for (std::size_t i = 0; i < e.x.size(); ++i)
      path.append(i == 0 ? "M" : "L").append(frame.at(e.x[i], e.high[i]));
    for (std::size_t i = e.x.size(); i-- > 0;) path.append("L").append(frame.at(e.x[i], e.y[i]));
    return fmt::format("<path d='{}Z' fill='{}' fill-opacity='{}'/>", path,
                       escape_html(e.style.colour), e.style.opacity);
  }
  bool pen_down = false;
  for (std::size_t i = 0; i < e.x.size(); ++i) {
    if (!std::isfinite(e.x[i]) || !std::isfinite(e.y[i])) {
      pen_down = false;
      continue;
    }
    if (e.kind == Element::Kind::kPoints) {
      path.append("M")
          .append(frame.at(e.x[i], e.y[i]))
          .append("h0");  // a round cap makes the point
    } else {
      path.append(pen_down ? "L" : "M").append(frame.at(e.x[i], e.y[i]));
      pen_down = true;
    }
  }
  return fmt::format(
      "<path d='{}' fill='none' {} stroke-linecap='round' stroke-linejoin='round'{}/>", path,
      stroke, e.style.dash.empty() ? "" : " stroke-dasharray='" + e.style.dash + "'");
}

std::string Plot::axes(const Frame& f) const {
  std::string out;
  for (const double v : f.y.at) {
    const double y = f.px_y(v);
    const bool zero = std::abs(v) < 1e-9 * (f.y.upper - f.y.lower);
    out += fmt::format("<path d='M{} {}H{}' class='{}'/>", px(f.left), px(y), px(f.right),
                       zero ? "zero" : "grid");
    out += fmt::format("<text x='{}' y='{}' text-anchor='end'>{}</text>", px(f.left - 6),
                       px(y + 3.8), f.y.label(v));
  }
  out += fmt::format("<path d='M{} {}H{}' class='axis'/>", px(f.left), px(f.bottom), px(f.right));
  for (const double v : f.x.at) {
    const double x = f.px_x(v);
    out += fmt::format(
        "<path d='M{} {}v4' class='axis'/><text x='{}' y='{}' text-anchor='middle'>"
        "{}</text>",
        px(x), px(f.bottom), px(x), px(f.bottom + 15), f.x.label(v));
  }
  if (!x_label_.empty())
    out += fmt::format("<text x='{}' y='{}' text-anchor='middle' class='name'>{}</text>",
                       px((f.left + f.right) / 2), height_ - 4, escape_html(x_label_));
  if (!y_label_.empty())
    out += fmt::format(
        "<text transform='translate(11 {}) rotate(-90)' text-anchor='middle' "
        "class='name'>{}</text>",
        px((f.top + f.bottom) / 2), escape_html(y_label_));
  if (!title_.empty())
    out +=
        fmt::format("<text x='{}' y='13' class='title'>{}</text>", px(f.left), escape_html(title_));
  return out;
}

std::string Plot::legend(const Frame& f) const {
  std::string out;
  double x = f.left;
  const double y = title_.empty() ? 10 : 28;
  for (const Element& e : elements_) {
    if (e.legend.empty()) continue;
    const bool block = e.kind == Element::Kind::kBand, dot = e.kind == Element::Kind::kPoints;
    out += fmt::format(
        "<path d='M{} {}h{}' stroke='{}' stroke-width='{}' stroke-opacity='{}' "
        "stroke-dasharray='{}' stroke-linecap='{}'/><text x='{}' y='{}'>{}</text>",
        px(dot ? x + 10 : x), px(y), dot ? 0 : 16, escape_html(e.style.colour),
        block ? 9.0
        : dot ? 5.0
              : std::max(2.0, e.style.width),
        block ? e.style.opacity : 1.0, e.style.dash, dot ? "round" : "butt", px(x + 21),
        px(y + 3.8), escape_html(e.legend));
    x += 21 + kCharacter * static_cast<double>(e.legend.size()) + 16;
  }
  return out;
}

// For those who do not see it.
std::string Plot::name() const {
  const std::string axes = y_label_ + " over " + x_label_;
  return title_.empty() ? axes : title_ + ": " + axes;
}

std::string Plot::svg() const {
  const bool has_legend = std::any_of(elements_.begin(), elements_.end(),
                                      [](const Element& e) { return !e.legend.empty(); });
  Frame f;
  f.top = 8 + (title_.empty() ? 0 : 16) + (has_legend ? 18 : 0);
  f.bottom = height_ - (x_label_.empty() ? 20 : 36);
  // A little air above and below the data, but none below a zero they stand on.
  double low = std::min(y_low_, y_high_), high = std::max(y_low_, y_high_);
  const double air = 0.04 * (high - low);
  if (low != 0) low -= air;
  if (high != 0) high += air;
  f.y = nice_ticks(low, high, std::max(2, static_cast<int>((f.bottom - f.top) / 34)), false);
  std::size_t widest = 5;  // so that plots beside each other mostly begin alike
  for (const double v : f.y.at) widest = std::max(widest, f.y.label(v).size());
  f.left = (y_label_.empty() ? 8 : 24) + kCharacter * static_cast<double>(widest) + 4;
  f.right = width_ - 12;
  f.x = nice_ticks(std::min(x_low_, x_high_), std::max(x_low_, x_high_),
                   std::max(2, static_cast<int>((f.right - f.left) / 70)), false);
  if (integer_x_) {
    std::erase_if(f.x.at, [](double v) { return std::abs(v - std::round(v)) > 1e-9; });
    f.x.decimals = 0;
  }
  std::string out = fmt::format(
      "<svg class='plot' viewBox='0 0 {0} {1}' width='{0}' height='{1}' role='img' "
      "aria-label='{2}'>",
      width_, height_, escape_html(name()));
  out += axes(f);
  for (const Element& e : elements_) out += draw(e, f);
  return out + legend(f) + "</svg>";
}

std::string Plot::file() const {
  static constexpr const char* kStyle =
      "<style>text{font:11px sans-serif;fill:#1b2733}.title{font-weight:600;font-size:12px}"
      ".name{fill:#5b6876}.grid{stroke:#e4e8ec;fill:none}.axis,.zero{stroke:#8a96a3;fill:none}"
      "</style><rect width='100%' height='100%' fill='#fff'/>";
  std::string text = svg();
  text.insert(text.find('>') + 1, kStyle);
  text.insert(4, " xmlns='http://www.w3.org/2000/svg'");
  return "<?xml version='1.0' encoding='UTF-8'?>\n" + text + "\n";
}

}  // namespace hapsim
