// Small plots as SVG text: axes with units, lines, points, bands, reference lines, a legend.
#pragma once

#include <string>
#include <vector>

#include "report/axis.h"

namespace hapsim {

struct PlotStyle {
  std::string colour = "#1b2733";
  double width = 1.5;  // of a line, or diameter of a point [px]
  double opacity = 1;
  std::string dash = "";  // "4 3"
};

class Plot {
 public:
  // Labels carry their unit: "depth [mm]". An empty label leaves its room to the plot.
  Plot(int width, int height, std::string x_label, std::string y_label);
  // NaN breaks a line. Every element widens the range of the axes; nothing is cut off.
  void line(const std::vector<double>& x, const std::vector<double>& y, const PlotStyle& style,
            const std::string& legend = "");
  void points(const std::vector<double>& x, const std::vector<double>& y, const PlotStyle& style,
              const std::string& legend = "");
  void band(const std::vector<double>& x, const std::vector<double>& low,
            const std::vector<double>& high, const PlotStyle& style,
            const std::string& legend = "");
  void level(double y, const PlotStyle& style, const std::string& legend = "");  // horizontal line
  void title(std::string text) { title_ = std::move(text); }
  void integer_x() { integer_x_ = true; }  // ticks at whole numbers only
  void include_y(double y);
  void include_x(double x);
  std::string svg() const;   // for a page with the report's style
  std::string file() const;  // an SVG file with its own style

 private:
  struct Element {
    enum class Kind { kLine, kPoints, kBand, kLevel } kind;
    std::vector<double> x, y, high;
    PlotStyle style;
    std::string legend;
  };
  struct Frame;
  std::string name() const;
  std::string draw(const Element& element, const Frame& frame) const;
  std::string axes(const Frame& frame) const;
  std::string legend(const Frame& frame) const;

  int width_, height_;
  std::string x_label_, y_label_, title_;
  std::vector<Element> elements_;
  bool integer_x_ = false;
  double x_low_ = 1e300, x_high_ = -1e300, y_low_ = 1e300, y_high_ = -1e300;
};

}  // namespace hapsim
