// hs-tetmesh: a closed surface becomes a body of tetrahedra on its support.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "cli/tool.h"
#include "geometry/body_mesh.h"
#include "geometry/quality.h"
#include "io/recording.h"

namespace hapsim {
namespace {

constexpr const char* kName = "hs-tetmesh";

ToolSpec specification() {
  ToolSpec spec;
  spec.name = kName;
  spec.summary = "fill a closed surface with tetrahedra";
  spec.input = "surface: PLY or STL, closed";
  spec.description = {
      "Reads a closed triangle surface, for example from hs-reconstruct, and writes the body: "
      "tetrahedra, boundary triangles and the nodes that are bonded to the support.",
      "The surface is coarsened where it is finer than the wished edge length, keeping its volume, "
      "its bends and the outline of the bonded part, and split where it is coarser. With "
      "--preserve-surface its triangles stay as they are. Without a size the body gets some "
      "thousand tetrahedra: hs-identify and hs-simulate mesh each contact position finely "
      "themselves and take the shape and the support from this body.",
      "The tetrahedra are made by TetGen in a process of its own. The surface is checked "
      "beforehand: open edges, doubled vertices, flat triangles, several parts, inverted "
      "orientation and self-intersections are refused with their place, exit code 3.",
      "On standard error: number of tetrahedra and nodes, volume, fixed nodes, and the quality as "
      "minimum, median and maximum of circumradius over shortest edge (a regular tetrahedron has "
      "0.61) and of each tetrahedron's smallest dihedral angle (70.5 degrees)."};
  spec.options = {
      {.flag = "--edge",
       .kind = OptionKind::kNumber,
       .value = "M",
       .help = "Wished edge length [m].",
       .minimum = 1e-6,
       .maximum = 10},
      {.flag = "--max-volume",
       .kind = OptionKind::kNumber,
       .value = "M3",
       .help = "Largest volume of a tetrahedron [m^3].",
       .minimum = 1e-18,
       .maximum = 1000},
      {.flag = "--radius-edge",
       .kind = OptionKind::kNumber,
       .value = "RATIO",
       .help = "Bound of circumradius over shortest edge; smaller is better shaped and more "
               "tetrahedra.",
       .default_text = "1.4",
       .minimum = 1.1,
       .maximum = 100},
      {.flag = "--min-dihedral",
       .kind = OptionKind::kNumber,
       .value = "DEG",
       .help = "Wished smallest dihedral angle [deg]; not always reached.",
       .default_text = "10",
       .minimum = 0,
       .maximum = 18},
      {.flag = "--preserve-surface",
       .kind = OptionKind::kSwitch,
       .help = "Keep the surface's triangles: no coarsening, no new node on it."},
      {.flag = "--order",
       .kind = OptionKind::kChoice,
       .value = "ORDER",
       .help = "First order (4 nodes) or second (10 nodes, middles on straight edges).",
       .default_text = "1",
       .choices = {"1", "2"}},
      {.flag = "--fixed",
       .value = "WHERE",
       .help = "What is bonded to the support: bottom (triangles flat on the lowest plane, within "
               "0.5 % of the height), plane:Z (on the plane at height Z), below:Z, none. Z in "
               "metres.",
       .default_text = "bottom"},
      {.flag = "--contacts",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Recording whose pressed positions are refined to half the tool's radius. Only "
               "needed when this mesh itself is to be pressed."},
      {.flag = "--tool-radius",
       .kind = OptionKind::kNumber,
       .value = "M",
       .help = "Radius of the tool [m]; otherwise the recording's metadata tool_radius.",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = "--unit",
       .kind = OptionKind::kText,
       .value = "UNIT",
       .help = "Unit of the surface's coordinates: m, mm, cm, um or in. The body is in metres.",
       .default_text = "m"},
      {.flag = "--vtu",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Also writes the body for ParaView."},
      {.flag = "--ascii", .kind = OptionKind::kSwitch, .help = "Text instead of binary PLY."}};
  spec.tables = {
      {"Body (output, PLY)",
       {{"vertex x, y, z", "node [m]"},
        {"vertex fixed", "1: bonded to the support"},
        {"face vertex_indices", "boundary triangle, outward"},
        {"tetrahedron vertex_indices",
         "4 corners; of second order 10 nodes, then the middles of the edges 01, 12, 02, 03, 13, "
         "23 as in VTK"},
        {"tetrahedron region", "number of the region, 0"}}}};
  spec.examples = {
      {"hs-tetmesh surface.ply -o body.ply", "A body of some thousand tetrahedra."},
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "From a scan to a body."},
      {"hs-tetmesh part.stl --unit mm --edge 0.004 --order 2 --vtu body.vtu -o body.ply",
       "An STL in millimetres, edges of 4 mm, second order, also for ParaView."},
      {"hs-tetmesh surface.ply --fixed below:0.01 --contacts data.csv -o body.ply",
       "Bonded up to 10 mm height, finer where the tool pressed."}};
  spec.see_also = {"hs-reconstruct(1)", "hs-identify(1)", "hs-simulate(1)"};
  return spec;
}

Surface read_scaled(const Arguments& arguments, std::string& where) {
  const double factor = unit_factor(Quantity::kLength, arguments.text("--unit"));
  Input input(arguments.input());
  where = input.name();
  Surface surface = read_surface(input);
  double largest = 0;
  for (Vec3& p : surface.vertices) {
    p *= factor;
    largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (largest > 10)
    fail_input(where, fmt::format("coordinates reach {:.6g} m", largest),
               "give --unit mm if these are millimetres");
  return surface;
}

void read_contacts(const Arguments& arguments, BodyOptions& options) {
  if (!arguments.given("--contacts")) return;
  if (arguments.text("--contacts") == "-" && arguments.input() == "-")
    fail_usage("both the surface and --contacts are to come from standard input",
               "give one of them as a file");
  Input input(arguments.text("--contacts"));
  const Recording recording = read_recording(input, false);
  options.tool_radius = arguments.given("--tool-radius") ? arguments.number("--tool-radius")
                                                         : recording.tool_radius();
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  options.contacts = recording.position;
  std::sort(options.contacts.begin(), options.contacts.end(), less);
  options.contacts.erase(std::unique(options.contacts.begin(), options.contacts.end()),
                         options.contacts.end());
}

void summarise(const Arguments& arguments, const TetMesh& mesh, const std::string& where) {
  const TetQuality quality = tet_quality(mesh);
  const auto fixed = std::count(mesh.fixed.begin(), mesh.fixed.end(), 1);
  say(arguments, kName,
      fmt::format("{} tetrahedra, {} nodes, {} boundary triangles, {:.6g} m^3, unit {}",
                  mesh.tets.size(), mesh.nodes.size(), mesh.faces.size(), quality.volume,
                  arguments.text("--unit")));
  say(arguments, kName,
      fixed > 0 ? fmt::format("{} nodes fixed ({})", fixed, arguments.text("--fixed"))
                : "no node fixed: fix some before this body is pressed");
  const Vec3& at = quality.worst_place;
  say(arguments, kName,
      fmt::format("radius-edge {:.2f} / {:.2f} / {:.2f}, smallest dihedral {:.1f} / {:.1f} / "
                  "{:.1f} deg, largest {:.1f} deg (min / median / max)",
                  quality.radius_edge.minimum, quality.radius_edge.median,
                  quality.radius_edge.maximum, quality.smallest_dihedral_deg.minimum,
                  quality.smallest_dihedral_deg.median, quality.smallest_dihedral_deg.maximum,
                  quality.largest_dihedral_deg));
  say(arguments, kName,
      fmt::format("worst tetrahedron {} at ({:.6g}, {:.6g}, {:.6g}), inverted {}", quality.worst,
                  at.x(), at.y(), at.z(), quality.inverted));
  if (quality.inverted > 0)
    fail_numerics(where, fmt::format("{} tetrahedra are inverted", quality.inverted),
                  "mesh with another --edge");
}

int run(const Arguments& arguments) {
  BodyOptions options;
  options.support = parse_support(arguments.text("--fixed"));
  if (arguments.given("--edge")) options.edge = arguments.number("--edge");
  if (arguments.given("--max-volume")) options.max_volume = arguments.number("--max-volume");
  options.radius_edge = arguments.number("--radius-edge");
  options.min_dihedral = arguments.number("--min-dihedral");
  options.preserve_surface = arguments.given("--preserve-surface");
  options.order = static_cast<int>(arguments.integer("--order"));
  std::string where;
  const Surface surface = read_scaled(arguments, where);
  read_contacts(arguments, options);
  const TetMesh mesh = make_body_mesh(surface, options, where);
  summarise(arguments, mesh, where);
  if (arguments.given("--vtu")) {
    Output vtu(arguments.text("--vtu"));
    write_body_vtu(vtu.stream(), mesh);
    vtu.commit();
  }
  Output output(arguments.output());
  write_body_ply(output.stream(), mesh, arguments.given("--ascii"));
  output.commit();
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
