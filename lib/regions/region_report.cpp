#include "regions/region_report.h"

#include <fmt/format.h>

#include "base/counted.h"
#include "io/csv.h"
#include "report/palette.h"
#include "report/plot.h"

namespace hapsim {

void write_boundary(std::ostream& out, const std::vector<BoundaryLine>& lines, int keys) {
  CsvWriter writer(out, {}, {"line", "region_a", "region_b", "point", "x", "y"});
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const auto points = key_points(lines[l], keys);
    for (std::size_t p = 0; p < points.size(); ++p)
      writer.row({std::to_string(l), std::to_string(lines[l].a), std::to_string(lines[l].b),
                  std::to_string(p), format_number(points[p].x()), format_number(points[p].y())});
  }
}

void write_dendrogram(std::ostream& out, const Dendrogram& tree) {
  CsvWriter writer(out, {}, {"node", "left", "right", "height", "size", "inconsistency"});
  const std::vector<double> ratio = inconsistency(tree);
  for (std::size_t m = 0; m < tree.merges.size(); ++m) {
    const Merge& merge = tree.merges[m];
    writer.row({std::to_string(tree.leaves + m), std::to_string(merge.left),
                std::to_string(merge.right), format_number(merge.height),
                std::to_string(merge.size), format_number(ratio[m])});
  }
}

std::string dendrogram_svg(const RegionEstimate& regions) {
  Plot plot(720, 360, "location samples in the tree's order", "distance [standard errors]");
  const Dendrogram& tree = regions.tree;
  const std::vector<int> order = leaf_order(tree);
  std::vector<double> x(tree.leaves + tree.merges.size()), height(x.size(), 0);
  std::vector<int> region(x.size(), -1);  // of a branch that lies in one, else -1
  for (std::size_t k = 0; k < order.size(); ++k) {
    x[order[k]] = static_cast<double>(k + 1);
    region[order[k]] = regions.label[order[k]];
  }
  plot.integer_x();
  plot.include_y(0);
  std::vector<bool> named(regions.value.size(), false);
  for (std::size_t m = 0; m < tree.merges.size(); ++m) {
    const auto [left, right, top, size] = tree.merges[m];
    const std::size_t at = tree.leaves + m;
    x[at] = 0.5 * (x[left] + x[right]);
    height[at] = top;
    if (region[left] == region[right]) region[at] = region[left];
    PlotStyle style;
    std::string legend;
    if (const int r = region[at]; r >= 0) {
      style.colour = version_colour(static_cast<std::size_t>(r));
      if (!named[r]) legend = fmt::format("region {}", r);
      named[r] = true;
    }
    plot.line({x[left], x[left], x[right], x[right]}, {height[left], top, top, height[right]},
              style, legend);
  }
  std::string svg = plot.svg();
  return svg.insert(svg.find("<svg") + 4, " xmlns=\"http://www.w3.org/2000/svg\"");
}

std::vector<std::string> region_lines(const RegionEstimate& regions, std::size_t samples) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& text) { lines.push_back(text); };
  line(fmt::format("{} location samples, {} linkage, cophenetic correlation {:.3f}", samples,
                   linkage_name(regions.linkage), regions.correlation));
  if (regions.correlation < 0.75)
    line("the tree keeps the distances badly: the samples hardly fall into groups");
  if (regions.tests.empty()) {
    line(fmt::format("{} regions, as asked", regions.value.size()));
  } else {
    const BranchTest& all = regions.tests.front();
    if (all.divided)
      line(fmt::format("{} regions (chance of such clusters in one region: {:.2g})",
                       regions.value.size(), all.p_gaps));
    else if (all.p_scatter > all.level)
      line(fmt::format("one region: the samples scatter as their standard errors say (p = {:.2g})",
                       all.p_scatter));
    else
      line(
          fmt::format("one region: the samples scatter {:.2g} times as widely as their standard "
                      "errors say, but fall into no groups (p = {:.2g}); the stiffness may vary "
                      "smoothly",
                      all.scatter, all.p_gaps));
  }
  if (regions.joined > 0)
    line(
        fmt::format("{} unlike all others joined the nearest region: pressed across a "
                    "boundary, or a region of their own (press around, or give --regions)",
                    counted(regions.joined, "sample", "samples")));
  if (regions.bordering > 0)
    line(fmt::format(
        "{} between a softer and a stiffer region joined the nearer one: pressed beside "
        "the boundary, or a strip of their own (press across it more densely, or give "
        "--regions)",
        counted(regions.bordering, "sample", "samples")));
  for (std::size_t r = 0; r < regions.value.size(); ++r) {
    const RegionValue& v = regions.value[r];
    line(fmt::format("region {}: {}, E = {:.4g} ± {:.2g} Pa, nu = {:.3g}{}", r,
                     counted(v.samples, "sample", "samples"), v.E, v.E_std, v.nu,
                     v.nu_std > 0 ? fmt::format(" ± {:.2g}", v.nu_std) : " (held)"));
  }
  return lines;
}

}  // namespace hapsim
