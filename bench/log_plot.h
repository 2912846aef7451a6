// A small plot with logarithmic axes as SVG.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace hapsim::bench {

class LogPlot {
 public:
  using Points = std::vector<std::pair<double, double>>;  // both positive
  LogPlot(std::string title, std::string x) : title_(std::move(title)), x_(std::move(x)) {}
  Points& line(const std::string& name) { return lines_.emplace_back(name, Points{}).second; }

  void write(std::ostream& out) const {
    double low[2] = {1e300, 1e300}, high[2] = {0, 0};
    for (const auto& [name, points] : lines_)
      for (const auto& [x, y] : points) {
        low[0] = std::min(low[0], x), high[0] = std::max(high[0], x);
        low[1] = std::min(low[1], y), high[1] = std::max(high[1], y);
      }
    int from[2], to[2];
    for (int k = 0; k < 2; ++k) {
      from[k] = static_cast<int>(std::floor(std::log10(low[k]) + 0.05));
      to[k] = std::max(from[k] + 1, static_cast<int>(std::ceil(std::log10(high[k]) - 0.05)));
    }
    const auto at_x = [&](double x) {
      return 60 + 440 * (std::log10(x) - from[0]) / (to[0] - from[0]);
    };
    const auto at_y = [&](double y) {
      return 330 - 290 * (std::log10(y) - from[1]) / (to[1] - from[1]);
    };
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 680 380\" "
           "font-family=\"sans-serif\" font-size=\"12\">\n"
           "<rect width=\"680\" height=\"380\" fill=\"white\"/>\n"
        << fmt::format("<text x=\"60\" y=\"22\" font-size=\"14\">{}</text>\n", title_)
        << fmt::format("<text x=\"280\" y=\"370\" text-anchor=\"middle\">{}</text>\n", x_);
    for (int e = from[0]; e <= to[0]; ++e) {
      const double x = at_x(std::pow(10, e));
      out << fmt::format(
          "<path d=\"M{0:.1f} 40V330\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"346\" "
          "text-anchor=\"middle\">{1:g}</text>\n",
          x, std::pow(10, e));
    }
    for (int e = from[1]; e <= to[1]; ++e) {
      const double y = at_y(std::pow(10, e));
      out << fmt::format(
          "<path d=\"M60 {0:.1f}H500\" stroke=\"#ddd\"/><text x=\"54\" y=\"{1:.1f}\" "
          "text-anchor=\"end\">{2:g}</text>\n",
          y, y + 4, std::pow(10, e));
    }
    static constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73",
                                               "#cc79a7", "#e69f00", "#56b4e9"};
    int number = 0;
    for (const auto& [name, points] : lines_) {
      const char* colour = kColours[number % 6];
      const int y = 60 + 20 * number++;
      out << fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"2\" d=\"", colour);
      for (std::size_t i = 0; i < points.size(); ++i)
        out << fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", at_x(points[i].first),
                           at_y(points[i].second));
      out << "\"/>\n";
      for (const auto& [px, py] : points)
        out << fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", at_x(px),
                           at_y(py), colour);
      out << fmt::format(
          "<path d=\"M512 {0}H532\" stroke=\"{1}\" stroke-width=\"2\"/><text "
          "x=\"538\" y=\"{2}\">{3}</text>\n",
          y, colour, y + 4, name);
    }
    out << "</svg>\n";
  }

 private:
  std::string title_, x_;
  std::deque<std::pair<std::string, Points>> lines_;  // references stay
};

}  // namespace hapsim::bench
