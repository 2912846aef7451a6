// hs-tetmesh: a closed surface becomes a body of tetrahedra on its support.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/shell_words.h"
#include "base/units.h"
#include "cli/tell.h"
#include "formats/body_input.h"
#include "formats/format_table.h"
#include "hs-tetmesh/flags.h"
#include "recording/contact_points.h"
#include "tetmesh/body_mesh.h"
#include "tetmesh/body_words.h"
#include "tetmesh/contact_mesh.h"
#include "tetmesh/given_mesh.h"

namespace hapsim {
namespace {

constexpr const char* kName = "hs-tetmesh";

ToolSpec specification() {
  ToolSpec spec;
  spec.name = kName;
  spec.task = Task::kBody;
  spec.summary = "fill a closed surface with tetrahedra";
  spec.input = "surface, closed: " + names_to_read(Content::kTriangles) +
               "; or a mesh: " + names_to_read(Content::kTetrahedra);
  spec.description = {
      "Reads a closed triangle surface, for example from hs-reconstruct, and writes the body: "
      "tetrahedra, boundary triangles and the nodes that are bonded to the support.",
      "The surface is coarsened where it is finer than the wished edge length, keeping its volume, "
      "its bends and the outline of the bonded part, and split where it is coarser. With "
      "--preserve-surface its triangles stay as they are. Without a size the body gets some "
      "thousand tetrahedra: hs-identify and hs-simulate mesh each contact position finely "
      "themselves, with the tool's rim imprinted (--contact-meshes shows these meshes), and take "
      "the shape and the support from this body.",
      "By default this is a quality mesh, the constrained Delaunay tetrahedra refined until the "
      "bounds hold. With --normal nothing is refined: the plain mesh, with which the thesis "
      "compares it.",
      "The tetrahedra are made by TetGen in a process of its own. The surface is checked: open "
      "edges, doubled vertices, flat triangles, several parts, inverted orientation and "
      "self-intersections are refused with their place, exit code 3.",
      "A mesh of tetrahedra (PLY, VTU, legacy VTK, Gmsh 1, 2.2 and 4.1 in ASCII, decks of Abaqus "
      "and "
      "CalculiX, models of FEBio from 2.0, XML scenes of SOFA with the mesh in themselves, "
      "TetGen's .node or "
      ".ele with the other beside it) is not meshed again but checked, mended and written: nodes "
      "of no "
      "tetrahedron and doubled tetrahedra are dropped, inverted ones turned, and it says so. Its "
      "fixed nodes stay unless --fixed is given; --order 2 adds middles. Flat tetrahedra are "
      "refused with their place. --remesh takes its boundary and meshes that.",
      "On standard error: number of tetrahedra and nodes, volume, fixed nodes, and the quality as "
      "minimum, median and maximum of circumradius over shortest edge (a regular tetrahedron has "
      "0.61), of each tetrahedron's smallest dihedral angle (70.5 degrees) and of the aspect, "
      "longest edge over inscribed radius scaled to 1 for a regular one; with --verbose their "
      "counts and the ten worst with their places."};
  spec.options = {
      {.flag = flag::edge,
       .value = "M",
       .help = "Wished edge length [m].",
       .group = "Mesh",
       .minimum = 1e-6,
       .maximum = 10},
      {.flag = flag::max_volume,
       .value = "M3",
       .help = "Largest volume of a tetrahedron [m^3].",
       .group = "Mesh",
       .minimum = 1e-18,
       .maximum = 1000},
      {.flag = flag::radius_edge,
       .value = "RATIO",
       .help = "Bound of circumradius over shortest edge; smaller is better shaped and more "
               "tetrahedra.",
       .group = "Mesh",
       .default_text = "1.4",
       .minimum = 1.1,
       .maximum = 100},
      {.flag = flag::min_dihedral,
       .value = "DEG",
       .help = "Wished smallest dihedral angle [deg]; not always reached.",
       .group = "Mesh",
       .default_text = "10",
       .minimum = 0,
       .maximum = 18},
      {.flag = flag::normal,
       .help = "The plain constrained Delaunay mesh of the surface: no bound on shapes or sizes.",
       .group = "Mesh"},
      {.flag = flag::preserve_surface,
       .help = "Keep the surface's triangles: no coarsening, no new node on it.",
       .group = "Mesh"},
      {.flag = flag::order,
       .value = "ORDER",
       .help = "First order (4 nodes) or second (10 nodes, middles on straight edges).",
       .group = "Mesh",
       .default_text = "1",
       .choices = {"1", "2"}},
      {.flag = flag::curved_to,
       .value = "FILE",
       .help = "With --order 2: lays the free boundary nodes, middles too, on this smooth surface. "
               "Written so to every format; hapsim's linear solver takes edges as straight.",
       .group = "Mesh"},
      {.flag = flag::fixed,
       .value = "WHERE",
       .help = "What is bonded to the support: bottom (the plane a PLY's comment base_plane tells, "
               "else triangles flat on the lowest plane; within 0.5 % of the height), plane:Z, "
               "plane:NX,NY,NZ,H (where n.x = H), below:Z, box:X0,Y0,Z0,X1,Y1,Z1, file:PATH (CSV "
               "with x,y,z: the nodes nearest to these points; or with node: their numbers from "
               "0), none; several joined by +. Metres, or with a unit: below:4mm.",
       .group = "Support and regions",
       .default_text = "bottom"},
      {.flag = flag::region,
       .value = "FILE",
       .help = "Closed surface inside the body; may be given again. Its tetrahedra get the "
               "numbers 1, 2, ... and end at its triangles; where it touches or leaves the body, "
               "they are chosen by their centres. A model's E of these regions acts there "
               "(hs-identify --add regions --regions labels).",
       .group = "Support and regions",
       .repeatable = true},
      {.flag = flag::contacts,
       .value = "FILE",
       .help = "Recording whose pressed positions become nodes and are refined about. Only needed "
               "when this mesh itself is to be pressed.",
       .group = "Contacts"},
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the tool [m]; otherwise the recording's metadata tool_radius.",
       .group = "Contacts",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::size,
       .value = "M",
       .help = "Edge length about the contacts [m]; otherwise half the tool's radius.",
       .group = "Contacts",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::growth,
       .value = "SLOPE",
       .help = "How much longer edges become over the distance from a contact.",
       .group = "Contacts",
       .default_text = "0.5",
       .minimum = 0.01,
       .maximum = 10},
      {.flag = flag::contact_meshes,
       .value = "PREFIX",
       .help =
           "Also writes the second-order mesh of each contact position, graded to the imprinted "
           "rim of the tool, as PREFIX-1.vtu, PREFIX-2.vtu, ...: what hs-identify solves.",
       .group = "Contacts"},
      {.flag = flag::unit,
       .value = "UNIT",
       .help = "Unit of the input's coordinates: m, mm, cm, um or in. The body is in metres.",
       .group = "Input",
       .default_text = "m"},
      {.flag = flag::remesh,
       .help = "Of a mesh of tetrahedra, take the boundary and mesh it anew.",
       .group = "Mesh"},
      {.flag = flag::time_limit,
       .value = "S",
       .help = "Ends TetGen after this time [s].",
       .group = "Mesh",
       .default_text = "600",
       .minimum = 0.1,
       .maximum = 1e6},
      {.flag = flag::vtu,
       .value = "FILE",
       .help = "Also writes the body for ParaView.",
       .group = "Output",
       .writes = {"vtu"}},
      {.flag = flag::gmsh,
       .value = "FILE",
       .help = "Also writes the body for Gmsh, ASCII.",
       .group = "Output",
       .writes = {"msh"}},
      {.flag = flag::gmsh_version,
       .value = "VERSION",
       .help = "Format of --gmsh, and of an output that ends in .msh.",
       .group = "Output",
       .default_text = "2.2",
       .choices = {"2.2", "4.1"}},
      {.flag = flag::inp,
       .value = "FILE",
       .help = "Also writes nodes, elements, sets and the boundary for Abaqus and CalculiX.",
       .group = "Output",
       .writes = {"inp"}},
      {.flag = flag::tetgen,
       .value = "PREFIX",
       .help = "Also writes PREFIX.node and PREFIX.ele.",
       .group = "Output"},
      {.flag = flag::json,
       .value = "FILE",
       .help = "Also writes sizes and quality, counts and worst tetrahedra as JSON.",
       .group = "Output",
       .writes = {"json"}},
      {.flag = flag::ascii, .help = "Text instead of binary PLY and VTU.", .group = "Output"}};
  spec.writes = extensions_to_write(Content::kTetrahedra);
  spec.tables = {
      {"Body (output, PLY)",
       {{"vertex x, y, z", "node [m]"},
        {"vertex fixed", "1: bonded to the support"},
        {"face vertex_indices", "boundary triangle, outward"},
        {"tetrahedron vertex_indices",
         "4 corners; of second order 10 nodes, then the middles of the edges 01, 12, 02, 03, 13, "
         "23 as in VTK"},
        {"tetrahedron region", "number of the region: 0, inner regions from 1"}}}};
  spec.examples = {
      {"hs-tetmesh surface.ply -o body.ply", "A body of some thousand tetrahedra."},
      {"hs-scan2ply scan.csv | hs-reconstruct | hs-tetmesh -o body.ply", "From a scan to a body."},
      {"hs-tetmesh part.stl --unit mm --edge 0.004 --order 2 --vtu body.vtu -o body.ply",
       "An STL in millimetres, edges of 4 mm, second order, also for ParaView."},
      {"hs-tetmesh surface.ply --fixed below:0.01 --contacts data.csv -o body.ply",
       "Bonded up to 10 mm height, finer where the tool pressed."},
      {"hs-tetmesh surface.ply --region tumour.stl --inp body.inp -o body.ply",
       "A second material inside, also for CalculiX."},
      {"hs-tetmesh other.msh --fixed bottom -o body.ply", "A mesh made by Gmsh becomes a body."}};
  spec.see_also = {"hs-reconstruct(1)", "hs-identify(1)", "hs-simulate(1)"};
  return spec;
}

BodyInput read_scaled(const Arguments& arguments, const std::string& path, std::string& where) {
  const double factor = unit_factor(Quantity::kLength, arguments[flag::unit]);
  Input input(path);
  where = input.name();
  BodyInput body = read_body_input(input, factor);
  require_metres(body, where);
  return body;
}

// A surface given by a flag; of a mesh, its boundary.
Surface read_side_surface(const Arguments& arguments, const std::string& path, std::string& where) {
  if (path == "-" && arguments.input() == "-")
    fail_usage("two inputs are to come from standard input", "give one of them as a file");
  BodyInput body = read_scaled(arguments, path, where);
  return body.mesh ? boundary_surface(body.mesh->mesh) : std::move(body.surface);
}

void read_contacts(const Arguments& arguments, BodyOptions& options) {
  if (!arguments.given(flag::contacts)) {
    if (arguments.given(flag::contact_meshes))
      fail_usage("--contact-meshes needs the positions", "give --contacts data.csv");
    return;
  }
  if (arguments[flag::contacts] == "-" && arguments.input() == "-")
    fail_usage("both the surface and --contacts are to come from standard input",
               "give one of them as a file");
  Input input(arguments[flag::contacts]);
  const Recording recording = read_recording(input, false);
  options.tool_radius =
      arguments.given(flag::tool_radius) ? arguments[flag::tool_radius] : recording.tool_radius();
  options.contacts = contact_points(recording);
}

BodyOptions read_options(const Arguments& arguments) {
  BodyOptions options;
  options.support = parse_support(arguments[flag::fixed]);
  if (arguments.given(flag::edge)) options.edge = arguments[flag::edge];
  if (arguments.given(flag::max_volume)) options.max_volume = arguments[flag::max_volume];
  options.radius_edge = arguments[flag::radius_edge];
  options.min_dihedral = arguments[flag::min_dihedral];
  options.plain = arguments[flag::normal];
  options.preserve_surface = arguments[flag::preserve_surface];
  options.order = arguments[flag::order] == "2" ? 2 : 1;
  if (arguments.given(flag::size)) options.contact_size = arguments[flag::size];
  options.growth = arguments[flag::growth];
  options.time_limit = arguments[flag::time_limit];
  std::string where;
  if (arguments.given(flag::region))
    for (const std::string& path : arguments.list(flag::region)) {
      Surface surface = read_side_surface(arguments, path, where);
      options.inner.push_back({std::move(surface), where});
    }
  if (arguments.given(flag::curved_to)) {
    if (options.order != 2)
      fail_usage("--curved-to bends second-order edges", "give --order 2 too");
    options.curved_to = read_side_surface(arguments, arguments[flag::curved_to], where);
  }
  read_contacts(arguments, options);
  return options;
}

// All outputs are written before the first is put in its place, and before anything is said: a
// reader of standard error that goes away costs no result.
void write_all(const Arguments& arguments, const TetMesh& mesh, const TetQuality& quality,
               const BodyReport& report, const std::vector<Vec3>& window) {
  std::vector<std::unique_ptr<Output>> outputs;
  const auto open = [&](const std::string& path) -> std::ostream& {
    outputs.push_back(std::make_unique<Output>(path));
    return outputs.back()->stream();
  };
  if (arguments.given(flag::vtu))
    write_mesh_vtu(open(arguments[flag::vtu]), mesh, arguments[flag::ascii]);
  if (arguments.given(flag::gmsh))
    write_mesh_gmsh(open(arguments[flag::gmsh]), mesh,
                    arguments[flag::gmsh_version] == "4.1" ? 41 : 22);
  if (arguments.given(flag::inp)) write_mesh_abaqus(open(arguments[flag::inp]), mesh);
  if (arguments.given(flag::tetgen)) {
    std::ostream& node = open(arguments[flag::tetgen] + ".node");
    write_mesh_tetgen(node, open(arguments[flag::tetgen] + ".ele"), mesh);
  }
  if (arguments.given(flag::json)) open(arguments[flag::json]) << body_json(mesh, quality, report);
  format_to_write(arguments.output(), Content::kTetrahedra)
      .write_mesh(open(result_file(arguments)), mesh,
                  {.ascii = arguments[flag::ascii],
                   .comments = window.empty() ? std::vector<std::string>{}
                                              : std::vector<std::string>{window_comment(window)},
                   .version = arguments[flag::gmsh_version]});
  for (const auto& output : outputs) output->commit();
}

void write_contact_meshes(const Arguments& arguments, const TetMesh& mesh,
                          const BodyOptions& options) {
  if (!arguments.given(flag::contact_meshes)) return;
  const ContactBase base = make_contact_base(mesh);
  Progress progress(arguments, "contact meshes", options.contacts.size());
  for (std::size_t i = 0; i < options.contacts.size(); ++i) {
    const double rim = options.contact_size > 0 ? options.contact_size : options.tool_radius / 8;
    const ContactMesh contact =
        make_contact_mesh(base, options.contacts[i], options.tool_radius, rim, options.growth);
    Output output(fmt::format("{}-{}.vtu", arguments[flag::contact_meshes], i + 1));
    write_mesh_vtu(output.stream(), contact.mesh, arguments[flag::ascii]);
    output.commit();
    progress.step();
  }
}

int run(const Arguments& arguments) {
  BodyOptions options = read_options(arguments);
  std::string where;
  BodyInput input = read_scaled(arguments, arguments.input(), where);
  put_on_base(options.support, input);
  BodyReport report;
  TetMesh mesh;
  if (input.mesh && !arguments[flag::remesh]) {
    MeshFile& file = *input.mesh;
    report.notes.push_back(
        fmt::format("{} of order {} taken as it is", file.format, file.mesh.order));
    if (const std::string mended = mended_words(file.repairs); !mended.empty())
      report.notes.push_back(mended);
    mesh = body_of_mesh(std::move(file.mesh), file.has_fixed && !arguments.given(flag::fixed),
                        options, where);
  } else {
    if (input.mesh) input.surface = boundary_surface(input.mesh->mesh);
    Progress progress(arguments, "meshing, fifths of a second", 0);
    options.heartbeat = [&progress] { progress.step(); };
    mesh = make_body_mesh(input.surface, options, where, &report);
  }
  if (const std::string weak = weak_support_words(mesh); !weak.empty())
    report.notes.push_back(weak);
  const TetQuality quality = tet_quality(mesh);
  if (quality.inverted > 0)
    fail_numerics(where, fmt::format("{} tetrahedra are inverted", quality.inverted),
                  "mesh with another --edge");
  write_contact_meshes(arguments, mesh, options);
  write_all(arguments, mesh, quality, report, input.window);
  Summary summary = body_summary(mesh, quality, report, arguments[flag::unit], arguments.verbose());
  if (arguments.output() != "-") {
    const std::string rest = " --body " + shell_quoted(arguments.output()) + " -o m0.csv";
    const char* usual = "data.csv";
    if (std::filesystem::exists(usual))
      summary.next = std::string("hs-identify ") + usual + rest;
    else
      summary.notes.push_back("with a recording of presses:  hs-identify RECORDING.csv" + rest);
  }
  say_summary(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
