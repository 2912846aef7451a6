// hs-scan2ply: the points of a scan, cleaned, with normals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cli/tool.h"
#include "geometry/clean_points.h"
#include "geometry/normals.h"
#include "io/number.h"

namespace hapsim {
namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-scan2ply";
  spec.summary = "clean points with normals from a scan";
  spec.input = "scan: CSV with columns x,y,z[,nx,ny,nz], PLY, or rows of x y z [nx ny nz]";
  spec.description = {
      "Reads the points of a surface scan by content and column name (any order, further columns "
      "are ignored), turns them into metres, removes what is not surface, gives every point an "
      "outward normal and writes a PLY of doubles for hs-reconstruct.",
      "Removed are, each counted in the summary: points equal to an earlier one; points closer "
      "than "
      "a thousandth of the usual spacing to another; isolated points, whose mean distance to their "
      "10 nearest is more than 3 times that of these neighbours (so an uneven density costs no "
      "points); points off the plane of their neighbours by more than 8 times these neighbours' "
      "own "
      "deviation (so a sharp edge keeps its points). --keep-outliers leaves the last two in.",
      "Normals, when the scan has none, are those of planes through the nearest points, as many as "
      "the noise asks for; they are turned alike along the minimum spanning tree of neighbours and "
      "then outward, away from the middle of the scan or, for a patch seen from one side, upward.",
      "A scan larger than 5 m or smaller than 1 mm is taken for one in another unit and refused."};
  spec.options = {{.flag = "--unit",
                   .kind = OptionKind::kChoice,
                   .value = "UNIT",
                   .help = "Unit of the coordinates.",
                   .default_text = "m",
                   .choices = {"m", "mm", "cm", "um", "in"}},
                  {.flag = "--spacing",
                   .kind = OptionKind::kNumber,
                   .value = "M",
                   .help = "Thins to one point (the mean) a cubic cell of this size [m].",
                   .minimum = 1e-6,
                   .maximum = 1},
                  {.flag = "--keep-outliers",
                   .kind = OptionKind::kSwitch,
                   .help = "Removes only points that are given twice."},
                  {.flag = "--ascii", .kind = OptionKind::kSwitch, .help = "Writes an ASCII PLY."}};
  spec.tables = {
      {"Input columns",
       {{"x, y, z", "point, in --unit"}, {"nx, ny, nz", "outward normal; all three or none"}}},
      {"Output, PLY element vertex",
       {{"x, y, z", "point [m], double"}, {"nx, ny, nz", "outward unit normal, double"}}}};
  spec.examples = {
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "A body from a scan."},
      {"hs-scan2ply touched.csv --unit mm --spacing 0.001 -o points.ply",
       "Millimetres; at most one point a cubic millimetre."}};
  spec.see_also = {"hs-reconstruct(1)", "hs-tetmesh(1)"};
  return spec;
}

// Extent of the middle 96 % along each axis, the longest: gross outliers do not count.
double extent(const std::vector<Vec3>& points) {
  double longest = 0;
  std::vector<double> along(points.size());
  const auto cut = static_cast<std::size_t>(0.02 * static_cast<double>(points.size()));
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points.size(); ++i) along[i] = points[i][k];
    std::sort(along.begin(), along.end());
    longest = std::max(longest, along[along.size() - 1 - cut] - along[cut]);
  }
  return longest;
}

void check_unit(const std::vector<Vec3>& points, const std::string& unit, const std::string& name) {
  const double size = extent(points);
  if (size > 5) {
    fail_input(name, fmt::format("the scan is {:.3g} m wide when read in {}", size, unit),
               "give its unit, as --unit mm");
  }
  if (size < 1e-3 && size > 0) {
    fail_input(name, fmt::format("the scan is {:.3g} mm wide when read in {}", 1e3 * size, unit),
               "give its unit, as --unit m");
  }
}

// Normals from a file: of unit length; a missing one (zero) makes all of them worthless.
void accept_normals(PointCloud& cloud) {
  for (Vec3& n : cloud.normals) {
    const double length = n.norm();
    if (!(length > 1e-6 && std::isfinite(length))) {
      cloud.normals.clear();
      return;
    }
    n /= length;
  }
}

int run(const Arguments& arguments) {
  Input input(arguments.input());
  PointCloud cloud = read_points(input);
  const std::string unit = arguments.text("--unit");
  const double factor = unit_factor(Quantity::kLength, unit);
  for (Vec3& p : cloud.points) p *= factor;
  check_unit(cloud.points, unit, input.name());
  accept_normals(cloud);

  CleanOptions options;
  options.remove_outliers = !arguments.given("--keep-outliers");
  if (arguments.given("--spacing")) options.spacing = arguments.number("--spacing");
  CleanReport removed;
  PointCloud clean = clean_points(cloud, options, input.name(), removed);
  std::string normals = "given";
  if (clean.normals.empty()) {
    NormalsReport report;
    estimate_normals(clean, Vec3::UnitZ(), report);
    normals = fmt::format("from {} neighbours, noise about {:.2g} mm", report.neighbours,
                          1e3 * report.noise);
  }
  Output output(arguments.output());
  write_points_ply(output.stream(), clean, arguments.given("--ascii"),
                   {"hs-scan2ply: points in m, read in " + unit});
  output.commit();
  say(arguments, "hs-scan2ply",
      fmt::format("{} points read in {}; removed {} given twice, {} nearly so, {} isolated, {} off "
                  "the surface, {} by thinning; kept {}, {:.3g} mm apart; normals {}",
                  removed.read, unit, removed.duplicates, removed.near_duplicates, removed.isolated,
                  removed.off_surface, removed.thinned, removed.kept,
                  1e3 * point_spacing(clean.points), normals));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
