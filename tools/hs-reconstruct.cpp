// hs-reconstruct: points of a surface to the closed surface of a body.
#include <vector>

#include "base/error.h"
#include "base/shell_words.h"
#include "base/units.h"
#include "cli/shared_flags.h"
#include "cli/tell.h"
#include "formats/format_table.h"
#include "formats/surface_io.h"
#include "io/number.h"
#include "reconstruct/surface_record.h"

namespace hapsim {
namespace flag {
inline constexpr ChoiceFlag method{"--method"}, unit{"--unit"};
inline constexpr SwitchFlag repair{"--repair"}, no_repair{"--no-repair"}, no_base{"--no-base"},
    ascii{"--ascii"};
inline constexpr LengthFlag base{"--base"}, base_depth{"--base-depth"}, edge{"--edge"};
inline constexpr SwitchFlag window{"--window"};
inline constexpr LengthFlag beyond{"--beyond"};
inline constexpr TextFlag up{"--up"};
inline constexpr IntegerFlag seed{"--seed"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-reconstruct";
  spec.task = Task::kBody;
  spec.summary = "closed surface of a body from scanned points, or from damaged triangles";
  spec.input = "points from hs-scan2ply (PLY), or CSV with x,y,z[,nx,ny,nz]; or triangles: " +
               names_to_read(Content::kTriangles);
  spec.description = {
      "Makes a closed, outward, manifold surface of one part without self-intersection, of even "
      "triangles, for hs-tetmesh. What cannot be scanned, the bottom, is put on a plane; it is "
      "exactly flat, so that hs-tetmesh finds and fixes it. Triangles that are given are repaired "
      "instead (see below).",
      "Method height, for points of the upper side only: a smooth outline about the points in plan "
      "view, heights over it by least squares whose smoothness is chosen by cross-validation, "
      "upright walls down to the bottom plane.",
      "The other methods are for points of the side too, or from all round. With a bottom plane "
      "the points are mirrored at it first and the result is cut there, so that walls run down to "
      "it and may overhang. Method poisson: Poisson reconstruction, which bridges gaps and "
      "averages noise. Method power-crust: the power diagram of the poles of the points' Voronoi "
      "cells (Amenta, Choi, Kolluri 2001). Method delaunay: the Delaunay triangles between "
      "tetrahedra inside and outside, told by the points' normals, for nearly uniform samples. "
      "Method advancing-front: Delaunay triangles added from the surest on; gaps are closed "
      "afterwards. Method wrap: a wrap about the points that bridges gaps of three spacings. "
      "After each the surface is made even and fitted to the points by robust least squares.",
      "Sharp edges: the points fall into smooth patches, grown over normals that do not blur at an "
      "edge, joined where they meet at less than 40 degrees; each has a plane, or quadratic fits "
      "where it is bent. The surface is cut along the seams of the patches and moved onto them. "
      "The summary says whether that brought the points nearer.",
      "Method auto takes poisson when more than half of the plan view was seen from below, or when "
      "sloping points reach the lowest level in more than 70 % of the directions, unless fewer "
      "than "
      "2 % of the points are steeper than 78 degrees and --base or --base-depth puts the bottom "
      "more "
      "than two spacings below the lowest; else height. Where "
      "poisson fails, or leaves a tenth of the points farther off than a quarter of their spacing "
      "and three times their scatter, "
      "the others are tried and the nearest is taken. The summary and the comments of the PLY name "
      "the method and why, the base plane and why.",
      "The base plane is, unless --base or --base-depth say otherwise: z = 0 when the lowest "
      "points (their 0.5 % quantile) come within twice their spacing, or 5 % of the height, of it; "
      "for the other methods the lowest points' level; for height a quarter of the patch's width "
      "below them, which "
      "is a guess. A body scanned from all round is cut flat 5 % of its height above its lowest "
      "points, unless --no-base.",
      "Repair of triangles, each step counted in the summary: vertices at one place merged; "
      "triangles without area or given twice dropped; open edges that nearly meet merged; sides "
      "split where a vertex lies on them; all turned alike and outward; touching parts taken "
      "apart; holes closed; triangles that cut each other replaced; overlapping parts joined; "
      "loose parts but the largest, and inner shells, removed. The triangles are otherwise left as "
      "they are, unless --edge asks for even ones. What cannot be mended is refused with its "
      "place; --method wrap then makes a surface about the triangles. --method poisson and the "
      "others take the vertices as points."};
  spec.options = {
      {.flag = flag::method,
       .value = "METHOD",
       .help = "How to reconstruct.",
       .group = "Method",
       .default_text = "auto",
       .choices = reconstruct_methods()},
      {.flag = flag::unit,
       .value = "UNIT",
       .help = "Unit of the coordinates; the output is in metres.",
       .group = "Input",
       .default_text = "m",
       .choices = {"m", "mm", "cm", "um", "in"}},
      {.flag = flag::repair,
       .help = "Repairs triangles; on without being asked for. With points: refused.",
       .group = "Method"},
      {.flag = flag::no_repair,
       .help = "Triangles must be sound already: what would be mended is refused.",
       .group = "Method"},
      {.flag = flag::base,
       .value = "Z",
       .help = "Height of the bottom plane along --up [m].",
       .group = "Bottom",
       .minimum = -10,
       .maximum = 10},
      {.flag = flag::base_depth,
       .value = "D",
       .help = "Puts the bottom plane this deep below the lowest point [m].",
       .group = "Bottom",
       .minimum = 0,
       .maximum = 10},
      {.flag = flag::window,
       .help = "The points are a window on a larger body, as touched points of an organ are: it "
               "goes on beyond them (method height), smoothly, at heights a fifth of the points' "
               "own range above or below them at most, by its thickness or half of the points' "
               "width, whichever is less. The outline of the points goes with the body, and fits "
               "allow for what nobody saw of it.",
       .group = "Bottom"},
      {.flag = flag::beyond,
       .value = "M",
       .help = "As --window, going on by so much [m].",
       .group = "Bottom",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::no_base,
       .help = "Leaves the underside of a body that was scanned from all round as it is; "
               "hs-tetmesh then needs --fixed.",
       .group = "Bottom"},
      {.flag = flag::up,
       .value = "X,Y,Z",
       .help = "Direction away from the bottom; the bottom plane is square to it. auto: z, or the "
               "mean normal of the points when that is more than 60 degrees off z.",
       .group = "Bottom",
       .default_text = "auto"},
      {.flag = flag::edge,
       .value = "M",
       .help = "Edge length of the triangles [m]; else about 2000 triangles, but none much finer "
               "than the points are apart.",
       .group = "Method",
       .minimum = 1e-5,
       .maximum = 1},
      {.flag = flag::seed,
       .value = "N",
       .help = "Seed of the triangulation's insertion order.",
       .group = "Method",
       .default_text = "1",
       .minimum = 0,
       .maximum = 4e9},
      {.flag = flag::json,
       .value = "FILE",
       .help = "Also writes what was done as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = flag::ascii,
       .help = "Writes text instead of binary PLY or STL.",
       .group = "Output"}};
  spec.writes = extensions_to_write(Content::kTriangles);
  spec.tables = {{"Output, PLY",
                  {{"vertex x, y, z", "point [m], double"},
                   {"face vertex_indices", "three corners, counter-clockwise from outside"},
                   {"comment method", "the method and why it was taken"},
                   {"comment base_plane", "nx ny nz h: the bottom is n.x = h [m]"}}}};
  // Printed by bench/reconstruct_bench.cpp (-DHAPSIM_BUILD_BENCH=ON); one run, seed 1.
  spec.tables.push_back(
      {"Methods compared: rms (largest) distance of the true surface [mm], as bench_reconstruct "
       "prints it; where auto is not the nearest, that is said",
       {{"cuboid",
         "sharp edges, noise 0.2 mm, 1 % outliers, points 3.1 mm apart: all but height "
         "0.017 (0.05), height 1.8"},
        {"step",
         "as cuboid, with an inner edge: 0.016 (0.07); wrap 0.39 (4.6), edges stay round; "
         "height 1.6"},
        {"ball",
         "noise 0.5 mm, 1 % outliers, 3.2 mm apart: all but height 0.34 to 0.36 (1.8 to "
         "2.3)"},
        {"organ",
         "noise 0.2 mm, 1 % outliers, 1.5 mm apart: all but height 0.084 to 0.090 (0.4 to "
         "1.1)"},
        {"organ-top",
         "its upper side alone over a bottom 10 mm below: height, which auto takes, 0.095 (1.0); "
         "poisson 0.145 (1.0); advancing-front fails"},
        {"touched",
         "organ in four zones shifted by 0.5 mm, 2.1 mm apart: all but height 0.35 (1.0)"},
        {"hare",
         "thin ears, 35,000 points 0.8 mm apart: power-crust 0.21 (1.8), advancing-front "
         "0.21 (2.4); auto takes poisson, 0.39 (3.7); delaunay 0.51 (5.5)"},
        {"foot",
         "with toes, 1.7 mm apart: wrap, which auto takes, 0.38 (4.7); the others fail, but "
         "height, 8.7"}}});
  spec.examples = {
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "A body from a scan."},
      {"hs-reconstruct points.ply --base 0 -o surface.ply", "The object stood on the plane z = 0."},
      {"hs-reconstruct touched.ply --method height --base-depth 0.02 -o surface.ply",
       "Touched points of an organ's top, 20 mm of tissue below the lowest."}};
  spec.examples.push_back({"hs-reconstruct damaged.stl --unit mm --json done.json -o surface.ply",
                           "Repairs a surface in millimetres."});
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

ReconstructOptions options_of(const Arguments& arguments) {
  ReconstructOptions options;
  options.method = method_named(arguments[flag::method]);
  if (arguments.given(flag::base) && arguments.given(flag::base_depth)) {
    fail_usage("--base and --base-depth contradict each other", "give one of them");
  }
  if (arguments[flag::repair] && arguments[flag::no_repair]) {
    fail_usage("--repair and --no-repair contradict each other", "give one of them");
  }
  if (arguments.given(flag::base)) options.base = arguments[flag::base];
  if (arguments.given(flag::base_depth)) options.base_depth = arguments[flag::base_depth];
  if (arguments[flag::window]) options.beyond = -1;
  if (arguments.given(flag::beyond)) options.beyond = arguments[flag::beyond];
  if (arguments.given(flag::edge)) options.edge = arguments[flag::edge];
  options.no_base = arguments[flag::no_base];
  options.up = parse_up(arguments[flag::up]);
  options.seed = static_cast<std::uint64_t>(arguments[flag::seed]);
  return options;
}

struct Result {
  Surface surface;
  SurfaceRecord record;
};

Result from_points(const Arguments& arguments, const PointCloud& cloud, const std::string& name) {
  ReconstructOptions options = options_of(arguments);
  Result result;
  ReconstructReport report;
  {
    Progress progress(arguments, "reconstructing", 0);
    options.step = [&] { progress.step(); };
    result.surface = reconstruct(cloud, options, name, report);
  }
  result.record = record_reconstruction(result.surface, report, cloud.points.size(), options.seed);
  return result;
}

Result from_triangles(const Arguments& arguments, const Surface& given, const std::string& name) {
  const ReconstructOptions options = options_of(arguments);
  Result result;
  RepairReport report;
  const bool wrapped = options.method == ReconstructMethod::kWrap;
  {
    Progress progress(arguments, "repairing", 0);
    result.surface =
        wrapped ? wrap_surface(given, options.edge, name) : repair_surface(given, name, report);
    progress.step();
  }
  if (arguments[flag::no_repair] && report.total() > 0) {
    fail_input(name, "the surface is not sound: " + report.text(), "leave --no-repair out");
  }
  if (options.edge > 0) result.surface = even_surface(result.surface, options.edge);
  result.record = record_repair(result.surface, wrapped ? nullptr : &report, given.faces.size());
  return result;
}

int run(const Arguments& arguments) {
  Input input(arguments.input());
  Shape shape = read_shape(input);
  const std::string unit = arguments[flag::unit];
  const double factor = unit_factor(Quantity::kLength, unit);
  for (Vec3& p : shape.cloud.points) p *= factor;
  for (Vec3& p : shape.surface.vertices) p *= factor;
  check_size(shape.has_triangles ? shape.surface.vertices : shape.cloud.points, unit, input.name());
  const ReconstructMethod method = method_named(arguments[flag::method]);
  const bool mend = shape.has_triangles &&
                    (method == ReconstructMethod::kAuto || method == ReconstructMethod::kWrap);
  if (shape.has_triangles && !mend) shape.cloud = points_of_triangles(shape.surface);
  if (!mend && (arguments[flag::repair] || arguments[flag::no_repair])) {
    if (!shape.has_triangles)
      fail_input(input.name(), "it holds no triangles that could be kept", "leave --repair out");
    fail_usage("--repair is for triangles that are kept", "leave it or --method out");
  }
  Result result = mend ? from_triangles(arguments, shape.surface, input.name())
                       : from_points(arguments, shape.cloud, input.name());

  Output output(result_file(arguments));
  format_to_write(arguments.output(), Content::kTriangles)
      .write_surface(output.stream(), result.surface,
                     {.ascii = arguments[flag::ascii], .comments = result.record.comments});
  output.commit();
  if (arguments.given(flag::json)) {
    Output json(arguments[flag::json]);
    json.stream() << result.record.json;
    json.commit();
  }
  if (arguments.output() != "-")
    result.record.summary.next = "hs-tetmesh " + shell_quoted(arguments.output()) + " -o body.ply";
  say_summary(arguments, result.record.summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
