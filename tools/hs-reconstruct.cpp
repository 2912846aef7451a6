// hs-reconstruct: points of a surface to the closed surface of a body.
#include <fmt/format.h>

#include <vector>

#include "base/error.h"
#include "cli/tool.h"
#include "geometry/reconstruct.h"
#include "io/number.h"

namespace hapsim {
namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-reconstruct";
  spec.summary = "closed surface of a body from scanned points";
  spec.input = "points from hs-scan2ply (PLY), or CSV with x,y,z[,nx,ny,nz] in metres";
  spec.description = {
      "Makes a closed, outward, manifold surface of one part without self-intersection, of even "
      "triangles, for hs-tetmesh. What cannot be scanned, the bottom, is put on a plane; it is "
      "exactly flat, so that hs-tetmesh finds and fixes it.",
      "Method height, for points of the upper side only: a smooth outline about the points in plan "
      "view, heights over it by least squares whose smoothness is chosen by cross-validation, "
      "upright walls down to the bottom plane. Method poisson, for points of the side too, or from "
      "all round: Poisson reconstruction; with a bottom plane the points are mirrored at it first "
      "and the result is cut there, so that walls run down to it and may overhang. The surface is "
      "then remeshed and fitted to the points by robust least squares; sharp edges are restored "
      "where "
      "the normals of the points fall into groups 45 degrees apart and the points come nearer to "
      "the "
      "surface for it.",
      "Method auto takes poisson when more than half of the plan view was seen from below, or when "
      "steep points reach the lowest level in more than 70 % of the directions; else height. The "
      "summary names the method and why, the base plane and why, and how far the points lie from "
      "the surface.",
      "The base plane is, unless --base or --base-depth say otherwise: z = 0 when the lowest "
      "points "
      "(their 0.5 % quantile) come within twice their spacing, or 5 % of the height, of it; for "
      "poisson the lowest points' level; for height a quarter of the patch's width below them, "
      "which "
      "is a guess. A body scanned from all round is cut flat 5 % of its height "
      "above its lowest points, unless --no-base."};
  spec.options = {
      {.flag = "--method",
       .kind = OptionKind::kChoice,
       .value = "METHOD",
       .help = "How to reconstruct.",
       .default_text = "auto",
       .choices = {"auto", "height", "poisson"}},
      {.flag = "--base",
       .kind = OptionKind::kNumber,
       .value = "Z",
       .help = "Height of the bottom plane along --up [m].",
       .minimum = -10,
       .maximum = 10},
      {.flag = "--base-depth",
       .kind = OptionKind::kNumber,
       .value = "D",
       .help = "Puts the bottom plane this deep below the lowest point [m].",
       .minimum = 0,
       .maximum = 10},
      {.flag = "--no-base",
       .kind = OptionKind::kSwitch,
       .help = "Leaves the underside of a body that was scanned from all round as it is; "
               "hs-tetmesh then needs --fixed."},
      {.flag = "--up",
       .kind = OptionKind::kText,
       .value = "X,Y,Z",
       .help = "Direction away from the bottom; the bottom plane is square to it. auto: z, or the "
               "mean normal of the points when that is more than 60 degrees off z.",
       .default_text = "auto"},
      {.flag = "--edge",
       .kind = OptionKind::kNumber,
       .value = "M",
       .help = "Edge length of the triangles [m]; else about 2000 triangles, but none much finer "
               "than the points are apart.",
       .minimum = 1e-5,
       .maximum = 1},
      {.flag = "--seed",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Seed of the triangulation's insertion order.",
       .default_text = "1",
       .minimum = 0,
       .maximum = 4e9},
      {.flag = "--ascii", .kind = OptionKind::kSwitch, .help = "Writes an ASCII PLY."}};
  spec.tables = {{"Output, PLY",
                  {{"vertex x, y, z", "point [m], double"},
                   {"face vertex_indices", "three corners, counter-clockwise from outside"},
                   {"comment base_plane", "nx ny nz h: the bottom is n.x = h [m]"}}}};
  spec.examples = {
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "A body from a scan."},
      {"hs-reconstruct points.ply --base 0 -o surface.ply", "The object stood on the plane z = 0."},
      {"hs-reconstruct touched.ply --method height --base-depth 0.02 -o surface.ply",
       "Touched points of an organ's top, 20 mm of tissue below the lowest."}};
  spec.see_also = {"hs-scan2ply(1)", "hs-tetmesh(1)"};
  return spec;
}

// "x,y,z"; empty for auto.
std::optional<Vec3> parse_up(const std::string& text) {
  if (text == "auto") return {};
  Vec3 up;
  std::size_t from = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t to = k < 2 ? text.find(',', from) : text.size();
    if (to == std::string::npos || !parse_number(text.substr(from, to - from), up[k])) {
      fail_usage("--up " + text + " is no direction", "write --up 0,0,1 or --up auto");
    }
    from = to + 1;
  }
  if (up.norm() < 1e-9) fail_usage("--up has no length", "write --up 0,0,1 or --up auto");
  return up;
}

int run(const Arguments& arguments) {
  ReconstructOptions options;
  const std::string method = arguments.text("--method");
  if (method == "height") options.method = ReconstructMethod::kHeight;
  if (method == "poisson") options.method = ReconstructMethod::kPoisson;
  if (arguments.given("--base") && arguments.given("--base-depth")) {
    fail_usage("--base and --base-depth contradict each other", "give one of them");
  }
  if (arguments.given("--base")) options.base = arguments.number("--base");
  if (arguments.given("--base-depth")) options.base_depth = arguments.number("--base-depth");
  if (arguments.given("--edge")) options.edge = arguments.number("--edge");
  options.no_base = arguments.given("--no-base");
  options.up = parse_up(arguments.text("--up"));
  options.seed = static_cast<std::uint64_t>(arguments.integer("--seed"));

  Input input(arguments.input());
  const PointCloud cloud = read_points(input);
  ReconstructReport report;
  const Surface surface = reconstruct(cloud, options, input.name(), report);

  std::vector<std::string> comments{
      fmt::format("hs-reconstruct: method {}, seed {}", report.method, options.seed)};
  std::string base = "no flat bottom";
  if (report.has_base) {
    const std::string plane =
        fmt::format("{} {} {} {}", format_number(report.up.x()), format_number(report.up.y()),
                    format_number(report.up.z()), format_number(report.base));
    comments.push_back("base_plane " + plane);
    base = report.tilted ? "base n.x = h with (nx ny nz h) = (" + plane + ")"
                         : fmt::format("base z = {:.4g} m", report.base);
    base += " (" + report.base_why + ")";
  }
  Output output(arguments.output());
  write_surface_ply(output.stream(), surface, arguments.given("--ascii"), comments);
  output.commit();
  say(arguments, "hs-reconstruct",
      fmt::format(
          "method {}: {}; {} points ({} after evening out) to {} vertices, {} faces of edge "
          "{:.2g} mm; volume {:.4g} cm^3; {}; points lie {:.2g} mm rms off the surface, "
          "{:.1f} % farther than 3 times that",
          report.method, report.why, cloud.points.size(), report.points, surface.vertices.size(),
          surface.faces.size(), 1e3 * report.edge, 1e6 * signed_volume(surface), base,
          1e3 * report.rms, 100 * report.far_share));
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
