// TetGen's .node or .ele: the other one is read from beside it. Region: the first attribute.
#include <fmt/format.h>

#include <ostream>

#include "base/error.h"
#include "containers/text_scanner.h"
#include "formats/format.h"
#include "formats/mesh_file.h"
#include "io/stream.h"

namespace hapsim {
namespace {

constexpr const char* kFixedNote = "# hapsim; attribute: fixed";
// TetGen's middles of a second-order tetrahedron, by hapsim's edges.
constexpr int kMiddle[6] = {6, 7, 9, 5, 8, 4};

std::vector<long> first_numbers(const std::string& bytes) {
  const std::string none;
  TextScanner scan(std::string_view(bytes).substr(0, 4096), none, '#');
  std::vector<long> numbers;
  try {
    if (scan.done()) return {};
    const long line = scan.line_number();
    while (!scan.done() && scan.line_number() == line && numbers.size() < 5)
      numbers.push_back(scan.integer("", 0, 2147483647));
  } catch (const Error&) {
    return {};
  }
  return numbers;
}

bool is_node(const std::string& bytes) {
  const auto n = first_numbers(bytes);
  return n.size() >= 2 && n.size() <= 4 && n[1] == 3;
}

bool is_ele(const std::string& bytes) {
  const auto n = first_numbers(bytes);
  return n.size() >= 2 && n.size() <= 3 && (n[1] == 4 || n[1] == 10);
}

// Returns the number of the first node.
long read_nodes(const std::string& bytes, const std::string& where, RawMesh& mesh) {
  TextScanner scan(bytes, where, '#');
  const std::size_t count = scan.count("the number of nodes", 6);
  scan.integer("the dimension", 3, 3);
  const long attributes = scan.integer("the number of attributes", 0, 1000);
  const long markers = scan.integer("the number of markers", 0, 1);
  const bool fixed = attributes > 0 && bytes.starts_with(kFixedNote);
  long first = 0;
  mesh.nodes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const long number = scan.integer("the number of a node", 0, 2147483647);
    if (i == 0) first = number;
    if (number != first + static_cast<long>(i))
      scan.fail(
          fmt::format("node {} stands where {} should", number, first + static_cast<long>(i)));
    Vec3& p = mesh.nodes.emplace_back();
    for (int k = 0; k < 3; ++k) p[k] = scan.number("a coordinate");
    for (long a = 0; a < attributes; ++a) {
      const double value = scan.number("an attribute");
      if (fixed && a == 0) mesh.fixed.push_back(value != 0);
    }
    if (markers > 0) scan.number("a marker");
  }
  return first;
}

void read_ele(const std::string& bytes, const std::string& where, long first, RawMesh& mesh) {
  TextScanner scan(bytes, where, '#');
  const std::size_t count = scan.count("the number of tetrahedra", 10);
  const long corners = scan.integer("the number of nodes a tetrahedron", 4, 10);
  if (corners != 4 && corners != 10) scan.fail("tetrahedra have 4 or 10 nodes");
  const long attributes = scan.integer("the number of attributes", 0, 1000);
  const long last = first + static_cast<long>(mesh.nodes.size()) - 1;
  for (std::size_t t = 0; t < count; ++t) {
    scan.integer("the number of a tetrahedron", 0, 2147483647);
    int node[10], own[10];
    for (long k = 0; k < corners; ++k)
      node[k] = static_cast<int>(scan.integer("the node of a tetrahedron", first, last) - first);
    for (int k = 0; k < 4; ++k) own[k] = node[k];
    for (int e = 0; e < 6 && corners == 10; ++e) own[4 + e] = node[kMiddle[e]];
    int region = 0;
    for (long a = 0; a < attributes; ++a) {
      const double value = scan.number("an attribute");
      if (a == 0 && std::abs(value) < 2e9) region = static_cast<int>(value);
    }
    mesh.add(own, static_cast<std::size_t>(corners), region);
  }
}

// Points whose first coordinates happen to be a header of TetGen, which has more in its rows.
bool is_rows_of_three(const std::string& bytes) {
  const std::string none;
  TextScanner scan(std::string_view(bytes).substr(0, 4096), none, '#');
  for (int row = 0; row < 2; ++row) {
    if (scan.done()) return false;
    const long line = scan.line_number();
    int words = 0;
    for (; !scan.done() && scan.line_number() == line; ++words) scan.word();
    if (words != 3) return false;
  }
  return true;
}

Content sniff(const std::string& bytes) {
  const bool is_ours = (is_node(bytes) || is_ele(bytes)) && !is_rows_of_three(bytes);
  return is_ours ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  const bool node_given = is_node(bytes);
  const std::string own = node_given ? ".node" : ".ele", other = node_given ? ".ele" : ".node";
  if (where.size() <= own.size() || !where.ends_with(own))
    fail_input(where, "a TetGen mesh is two files, .node and .ele, and this is one of them",
               "give the path of the " + own + " file with the other beside it");
  Input input(where.substr(0, where.size() - own.size()) + other);
  const std::string beside = input.read_all();
  if (node_given ? !is_ele(beside) : !is_node(beside))
    fail_input(input.name(), "is no TetGen " + other + " file", "write the mesh again");
  RawMesh mesh;
  mesh.format = "TetGen";
  const long first =
      read_nodes(node_given ? bytes : beside, node_given ? where : input.name(), mesh);
  read_ele(node_given ? beside : bytes, node_given ? input.name() : where, first, mesh);
  return mesh;
}

}  // namespace

// Two files, so there is no writer into one stream; their names end in .node and .ele.
const Format& tetgen_format() {
  static const Format format{
      .name = "TetGen", .extensions = {"node", "ele"}, .sniff = sniff, .read_mesh = read_mesh};
  return format;
}

void write_mesh_tetgen(std::ostream& node, std::ostream& ele, const TetMesh& mesh) {
  node << kFixedNote << '\n' << fmt::format("{} 3 1 0\n", mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    node << fmt::format("{} {} {} {} {}\n", n, mesh.nodes[n].x(), mesh.nodes[n].y(),
                        mesh.nodes[n].z(), static_cast<int>(mesh.fixed[n]));
  const int width = mesh.order == 1 ? 4 : 10;
  ele << fmt::format("{} {} 1\n", mesh.tets.size(), width);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    int corner[10];
    for (int k = 0; k < 4; ++k) corner[k] = mesh.tets[t][k];
    for (int e = 0; e < 6; ++e) corner[kMiddle[e]] = mesh.tets[t][4 + e];
    ele << t;
    for (int k = 0; k < width; ++k) ele << ' ' << corner[k];
    ele << ' ' << mesh.region[t] << '\n';
  }
}

}  // namespace hapsim
