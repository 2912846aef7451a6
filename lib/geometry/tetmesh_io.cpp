// The body file: PLY with tetrahedra, and its copy for ParaView.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "base/error.h"
#include "geometry/tetmesh.h"
#include "io/ply.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "write it with hs-tetmesh";

const PlyElement& element(const PlyFile& file, const char* name, const std::string& where) {
  const PlyElement* found = file.find(name);
  if (found == nullptr || found->count == 0)
    fail_input(where, fmt::format("not a body: no element '{}'", name),
               std::string("give a body PLY; ") + kMend);
  return *found;
}

const PlyProperty& property(const PlyElement& element, const char* name, bool is_list,
                            const std::string& where) {
  const PlyProperty* found = element.find(name);
  if (found == nullptr || found->is_list != is_list)
    fail_input(where,
               fmt::format("element '{}' has no {} '{}'", element.name,
                           is_list ? "list" : "property", name),
               kMend);
  return *found;
}

// The node number of a list entry, checked.
int node_index(double value, std::size_t nodes, const char* what, std::size_t item,
               const std::string& where) {
  if (!(value >= 0 && value < static_cast<double>(nodes)) || value != std::floor(value))
    fail_input(
        where,
        fmt::format("{} {}: node {} is out of range (0 to {})", what, item, value, nodes - 1),
        kMend);
  return static_cast<int>(value);
}

const PlyProperty& index_list(const PlyElement& element, const std::string& where) {
  // Both names are in use for the corners of faces.
  if (element.find("vertex_indices") == nullptr && element.find("vertex_index") != nullptr)
    return property(element, "vertex_index", true, where);
  return property(element, "vertex_indices", true, where);
}

void read_nodes(const PlyFile& file, const std::string& where, TetMesh& mesh) {
  const PlyElement& vertex = element(file, "vertex", where);
  const auto& x = property(vertex, "x", false, where).values;
  const auto& y = property(vertex, "y", false, where).values;
  const auto& z = property(vertex, "z", false, where).values;
  for (std::size_t i = 0; i < vertex.count; ++i) {
    mesh.nodes.emplace_back(x[i], y[i], z[i]);
    if (!mesh.nodes.back().allFinite())
      fail_input(where, fmt::format("node {} is not finite", i), kMend);
  }
  mesh.fixed.assign(vertex.count, 0);
  if (const PlyProperty* fixed = vertex.find("fixed"); fixed != nullptr && !fixed->is_list)
    for (std::size_t i = 0; i < vertex.count; ++i) mesh.fixed[i] = fixed->values[i] != 0;
}

void read_tets(const PlyFile& file, const std::string& where, TetMesh& mesh) {
  const PlyElement& tetrahedron = element(file, "tetrahedron", where);
  const PlyProperty& list = index_list(tetrahedron, where);
  mesh.tets.reserve(tetrahedron.count);
  for (std::size_t i = 0; i < tetrahedron.count; ++i) {
    const std::size_t begin = list.offset[i], count = list.offset[i + 1] - begin;
    if (i == 0 && (count == 4 || count == 10)) mesh.order = count == 4 ? 1 : 2;
    if (count != (mesh.order == 1 ? 4u : 10u))
      fail_input(where, fmt::format("tetrahedron {} has {} nodes", i, count),
                 "give all 4 nodes (first order) or all 10 (second order)");
    auto& t = mesh.tets.emplace_back();
    t.fill(-1);
    for (std::size_t k = 0; k < count; ++k)
      t[k] = node_index(list.values[begin + k], mesh.nodes.size(), "tetrahedron", i, where);
    double longest = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b)
        longest = std::max(longest, (mesh.nodes[t[a]] - mesh.nodes[t[b]]).norm());
    // Below this a tetrahedron is flat to rounding; real meshes stay orders of magnitude above.
    if (const double v = tet_volume(mesh, i); !(v > 1e-12 * longest * longest * longest)) {
      const Vec3 c =
          0.25 * (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]);
      fail_input(where,
                 fmt::format("tetrahedron {} at ({:.6g}, {:.6g}, {:.6g}) is {}", i, c.x(), c.y(),
                             c.z(), v < 0 ? "inverted" : "flat"),
                 "mesh the surface again with hs-tetmesh");
    }
  }
  mesh.region.assign(tetrahedron.count, 0);
  if (const PlyProperty* region = tetrahedron.find("region"); region && !region->is_list)
    for (std::size_t i = 0; i < tetrahedron.count; ++i)
      mesh.region[i] = static_cast<int>(region->values[i]);
}

void read_faces(const PlyFile& file, const std::string& where, TetMesh& mesh) {
  const PlyElement* face = file.find("face");
  if (face == nullptr || face->count == 0) {
    mesh.faces = boundary_faces(mesh);
    return;
  }
  const PlyProperty& list = index_list(*face, where);
  for (std::size_t i = 0; i < face->count; ++i) {
    if (list.offset[i + 1] - list.offset[i] != 3)
      fail_input(where, fmt::format("face {} is not a triangle", i), kMend);
    Triangle& f = mesh.faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      f[k] = node_index(list.values[list.offset[i] + k], mesh.nodes.size(), "face", i, where);
  }
}

// A node of no tetrahedron would leave the stiffness singular.
void drop_unused_nodes(TetMesh& mesh) {
  std::vector<int> number(mesh.nodes.size(), -1);
  const int per_tet = mesh.order == 1 ? 4 : 10;
  for (const auto& t : mesh.tets)
    for (int k = 0; k < per_tet; ++k) number[t[k]] = 0;
  std::size_t used = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    mesh.nodes[used] = mesh.nodes[n];
    mesh.fixed[used] = mesh.fixed[n];
    number[n] = static_cast<int>(used++);
  }
  if (used == number.size()) return;
  mesh.nodes.resize(used);
  mesh.fixed.resize(used);
  for (auto& t : mesh.tets)
    for (int k = 0; k < per_tet; ++k) t[k] = number[t[k]];
  std::erase_if(mesh.faces, [&](const Triangle& f) {
    return number[f[0]] < 0 || number[f[1]] < 0 || number[f[2]] < 0;
  });
  for (Triangle& f : mesh.faces)
    for (int& n : f) n = number[n];
}

PlyProperty scalar(const char* name, PlyType type, std::size_t count) {
  PlyProperty p;
  p.name = name;
  p.type = type;
  p.values.reserve(count);
  return p;
}

PlyProperty indices(std::size_t count, std::size_t width) {
  PlyProperty p;
  p.name = "vertex_indices";
  p.type = PlyType::kInt32;
  p.is_list = true;
  p.values.reserve(count * width);
  for (std::size_t i = 0; i <= count; ++i) p.offset.push_back(i * width);
  return p;
}

template <class Range>
void vtu_array(std::ostream& out, const char* type, const char* name, int components,
               const Range& values) {
  out << fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
      "format=\"ascii\">\n",
      type, name, components);
  fmt::memory_buffer text;
  int column = 0;
  for (const auto& value : values)
    fmt::format_to(std::back_inserter(text), "{}{}", value, ++column % 12 == 0 ? '\n' : ' ');
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out << "\n</DataArray>\n";
}

}  // namespace

TetMesh read_body(Input& input) {
  const std::string bytes = input.read_all(), where = input.name();
  if (bytes.compare(0, 3, "ply") != 0)
    fail_input(where, bytes.empty() ? "empty input" : "not a PLY file", kMend);
  const PlyFile file = parse_ply(bytes, where);
  TetMesh mesh;
  read_nodes(file, where, mesh);
  read_tets(file, where, mesh);
  read_faces(file, where, mesh);
  drop_unused_nodes(mesh);
  if (std::find(mesh.fixed.begin(), mesh.fixed.end(), 1) == mesh.fixed.end())
    fail_input(where, "no node is fixed: the body would float",
               "mesh with hs-tetmesh --fixed bottom, or set the vertex property 'fixed'");
  return mesh;
}

void write_body_ply(std::ostream& out, const TetMesh& mesh, bool ascii) {
  PlyFile file;
  file.format = ascii ? PlyFormat::kAscii : PlyFormat::kBinaryLittle;
  file.comments = {"hapsim body, metres; fixed: 1 is bonded to the support"};
  const std::size_t n = mesh.nodes.size(), width = mesh.order == 1 ? 4 : 10;

  PlyElement vertex{"vertex", n, {}};
  const char* const axis[3] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    vertex.properties.push_back(scalar(axis[k], PlyType::kFloat64, n));
    for (const Vec3& p : mesh.nodes) vertex.properties.back().values.push_back(p[k]);
  }
  vertex.properties.push_back(scalar("fixed", PlyType::kUint8, n));
  for (const auto fixed : mesh.fixed) vertex.properties.back().values.push_back(fixed);

  PlyElement face{"face", mesh.faces.size(), {indices(mesh.faces.size(), 3)}};
  for (const Triangle& f : mesh.faces)
    for (const int k : f) face.properties[0].values.push_back(k);

  PlyElement tet{"tetrahedron", mesh.tets.size(), {indices(mesh.tets.size(), width)}};
  for (const auto& t : mesh.tets)
    for (std::size_t k = 0; k < width; ++k) tet.properties[0].values.push_back(t[k]);
  tet.properties.push_back(scalar("region", PlyType::kInt32, mesh.tets.size()));
  for (const int region : mesh.region) tet.properties.back().values.push_back(region);

  file.elements = {std::move(vertex), std::move(face), std::move(tet)};
  write_ply(out, file);
}

void write_body_vtu(std::ostream& out, const TetMesh& mesh) {
  const std::size_t width = mesh.order == 1 ? 4 : 10;
  std::vector<double> points;
  for (const Vec3& p : mesh.nodes) points.insert(points.end(), p.data(), p.data() + 3);
  std::vector<int> connectivity, offsets, types(mesh.tets.size(), mesh.order == 1 ? 10 : 24);
  for (const auto& t : mesh.tets) {
    connectivity.insert(connectivity.end(), t.begin(), t.begin() + static_cast<long>(width));
    offsets.push_back(static_cast<int>(connectivity.size()));
  }
  const std::vector<int> fixed(mesh.fixed.begin(), mesh.fixed.end());
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
      << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.nodes.size(),
                     mesh.tets.size());
  out << "<Points>\n";
  vtu_array(out, "Float64", "Points", 3, points);
  out << "</Points>\n<Cells>\n";
  vtu_array(out, "Int32", "connectivity", 1, connectivity);
  vtu_array(out, "Int32", "offsets", 1, offsets);
  vtu_array(out, "UInt8", "types", 1, types);
  out << "</Cells>\n<PointData>\n";
  vtu_array(out, "UInt8", "fixed", 1, fixed);
  out << "</PointData>\n<CellData>\n";
  vtu_array(out, "Int32", "region", 1, mesh.region);
  out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace hapsim
