// PLY: points, surfaces, and bodies by the element tetrahedron.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "containers/ply.h"
#include "formats/format.h"
#include "formats/surface_io.h"
#include "formats/tetmesh_io.h"

namespace hapsim {
namespace {

// What the header declares; without vertices the reader says what is missing.
Content sniff(const std::string& bytes) {
  if (!is_ply(bytes)) return Content::kNothing;
  const auto declares = [&](std::string_view element) {
    const std::string_view header = std::string_view(bytes).substr(0, bytes.find("end_header"));
    const std::string key = "\nelement " + std::string(element) + " ";
    const std::size_t at = header.find(key);
    if (at == header.npos) return false;
    const std::string_view count = header.substr(at + key.size());
    return !count.starts_with('0');
  };
  if (declares("tetrahedron")) return Content::kTetrahedra;
  return declares("face") || !declares("vertex") ? Content::kTriangles : Content::kPoints;
}

std::string describe_points(const std::string&) {
  return "a PLY without faces";
}

const PlyElement& required_element(const PlyFile& file, const char* element,
                                   const std::string& name) {
  const PlyElement* found = file.find(element);
  if (found == nullptr || found->count == 0) {
    fail_input(name, fmt::format("the PLY file has no element '{}'", element),
               "give a file with points" + std::string(element[0] == 'f' ? " and faces" : ""));
  }
  return *found;
}

// Three scalar properties as vectors; empty when any is absent.
std::vector<Vec3> vectors(const PlyElement& element, const std::array<const char*, 3>& names) {
  std::array<const PlyProperty*, 3> column;
  for (int k = 0; k < 3; ++k) {
    column[k] = element.find(names[k]);
    if (column[k] == nullptr || column[k]->is_list) return {};
  }
  std::vector<Vec3> result(element.count);
  for (std::size_t i = 0; i < element.count; ++i) {
    for (int k = 0; k < 3; ++k) result[i][k] = column[k]->values[i];
  }
  return result;
}

std::vector<Vec3> ply_points(const PlyFile& file, const std::string& name) {
  std::vector<Vec3> points = vectors(required_element(file, "vertex", name), {"x", "y", "z"});
  if (points.empty()) {
    fail_input(name, "the PLY element 'vertex' has no x, y, z", "name the coordinates x, y and z");
  }
  return points;
}

Surface read_surface(const std::string& bytes, const std::string& name) {
  const PlyFile file = parse_ply(bytes, name);
  Surface surface;
  surface.vertices = ply_points(file, name);
  const PlyElement& element = required_element(file, "face", name);
  const PlyProperty* list = element.find("vertex_indices");
  if (list == nullptr) list = element.find("vertex_index");
  if (list == nullptr || !list->is_list) {
    fail_input(name, "the PLY element 'face' has no list 'vertex_indices'",
               "write faces as 'property list uchar int vertex_indices'");
  }
  const auto vertices = static_cast<double>(surface.vertices.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    const std::size_t begin = list->offset[i];
    const std::size_t corners = list->offset[i + 1] - begin;
    if (corners < 3) {
      fail_input(name, fmt::format("face {} has {} corners", i, corners), "give at least three");
    }
    for (std::size_t k = begin; k < begin + corners; ++k) {
      if (!(list->values[k] >= 0 && list->values[k] < vertices)) {
        fail_input(name, fmt::format("face {} names vertex {} of {}", i, list->values[k], vertices),
                   "vertices count from 0");
      }
    }
    for (std::size_t k = 2; k < corners; ++k) {
      surface.faces.push_back({static_cast<int>(list->values[begin]),
                               static_cast<int>(list->values[begin + k - 1]),
                               static_cast<int>(list->values[begin + k])});
    }
  }
  return surface;
}

PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  const PlyFile file = parse_ply(bytes, name);
  PointCloud cloud;
  cloud.points = ply_points(file, name);
  cloud.normals = vectors(*file.find("vertex"), {"nx", "ny", "nz"});
  return cloud;
}

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

void read_nodes(const PlyFile& file, const std::string& where, RawMesh& mesh) {
  const PlyElement& vertex = element(file, "vertex", where);
  const auto& x = property(vertex, "x", false, where).values;
  const auto& y = property(vertex, "y", false, where).values;
  const auto& z = property(vertex, "z", false, where).values;
  for (std::size_t i = 0; i < vertex.count; ++i) {
    mesh.nodes.emplace_back(x[i], y[i], z[i]);
  }
  if (const PlyProperty* fixed = vertex.find("fixed"); fixed != nullptr && !fixed->is_list)
    for (const double value : fixed->values) mesh.fixed.push_back(value != 0);
}

void read_tets(const PlyFile& file, const std::string& where, RawMesh& mesh) {
  const PlyElement& tetrahedron = element(file, "tetrahedron", where);
  const PlyProperty& list = index_list(tetrahedron, where);
  const PlyProperty* region = tetrahedron.find("region");
  if (region != nullptr && region->is_list) region = nullptr;
  mesh.tets.reserve(tetrahedron.count);
  for (std::size_t i = 0; i < tetrahedron.count; ++i) {
    const std::size_t begin = list.offset[i], count = list.offset[i + 1] - begin;
    int corners[10];
    for (std::size_t k = 0; k < std::min<std::size_t>(count, 10); ++k)
      corners[k] = node_index(list.values[begin + k], mesh.nodes.size(), "tetrahedron", i, where);
    const double number = region != nullptr ? region->values[i] : 0;
    if ((count != 4 && count != 10) ||
        !mesh.add(corners, count, std::abs(number) < 2e9 ? static_cast<int>(number) : 0))
      fail_input(where, fmt::format("tetrahedron {} has {} nodes", i, count),
                 "give all 4 nodes (first order) or all 10 (second order)");
  }
}

void read_faces(const PlyFile& file, const std::string& where, RawMesh& mesh) {
  const PlyElement* face = file.find("face");
  if (face == nullptr || face->count == 0) return;
  const PlyProperty& list = index_list(*face, where);
  for (std::size_t i = 0; i < face->count; ++i) {
    if (list.offset[i + 1] - list.offset[i] != 3)
      fail_input(where, fmt::format("face {} is not a triangle", i), kMend);
    Triangle& f = mesh.faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      f[k] = node_index(list.values[list.offset[i] + k], mesh.nodes.size(), "face", i, where);
  }
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  const PlyFile file = parse_ply(bytes, where);
  RawMesh mesh;
  mesh.format = "PLY";
  read_nodes(file, where, mesh);
  read_tets(file, where, mesh);
  read_faces(file, where, mesh);
  return mesh;
}

void add_vectors(PlyElement& element, const std::array<const char*, 3>& names,
                 const std::vector<Vec3>& v) {
  for (int k = 0; k < 3; ++k) {
    PlyProperty property;
    property.name = names[k];
    property.values.reserve(v.size());
    for (const Vec3& p : v) property.values.push_back(p[k]);
    element.properties.push_back(std::move(property));
  }
}

PlyFile ply_of_points(const std::vector<Vec3>& points, bool ascii) {
  PlyFile file;
  file.format = ascii ? PlyFormat::kAscii : PlyFormat::kBinaryLittle;
  PlyElement vertex;
  vertex.name = "vertex";
  vertex.count = points.size();
  add_vectors(vertex, {"x", "y", "z"}, points);
  file.elements.push_back(std::move(vertex));
  return file;
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

}  // namespace

void write_surface_ply(std::ostream& out, const Surface& surface, bool ascii,
                       const std::vector<std::string>& comments) {
  PlyFile file = ply_of_points(surface.vertices, ascii);
  file.comments = comments;
  PlyElement face;
  face.name = "face";
  face.count = surface.faces.size();
  PlyProperty list;
  list.name = "vertex_indices";
  list.type = PlyType::kInt32;
  list.is_list = true;
  list.offset.push_back(0);
  for (const Triangle& f : surface.faces) {
    for (const int v : f) list.values.push_back(v);
    list.offset.push_back(list.values.size());
  }
  face.properties.push_back(std::move(list));
  file.elements.push_back(std::move(face));
  write_ply(out, file);
}

void write_points_ply(std::ostream& out, const PointCloud& cloud, bool ascii,
                      const std::vector<std::string>& comments) {
  PlyFile file = ply_of_points(cloud.points, ascii);
  file.comments = comments;
  if (!cloud.normals.empty()) {
    add_vectors(file.elements.front(), {"nx", "ny", "nz"}, cloud.normals);
  }
  write_ply(out, file);
}

void write_body_ply(std::ostream& out, const TetMesh& mesh, bool ascii,
                    const std::vector<std::string>& comments) {
  PlyFile file;
  file.format = ascii ? PlyFormat::kAscii : PlyFormat::kBinaryLittle;
  file.comments = {"hapsim body, metres; fixed: 1 is bonded to the support"};
  file.comments.insert(file.comments.end(), comments.begin(), comments.end());
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

const Format& ply_format() {
  static const Format format{
      .name = "PLY",
      .extensions = {"ply"},
      .sniff = sniff,
      .describe_points = describe_points,
      .read_points = read_points,
      .read_surface = read_surface,
      .read_mesh = read_mesh,
      .write_points =
          [](std::ostream& out, const PointCloud& cloud, const WriteOptions& o) {
            write_points_ply(out, cloud, o.ascii, o.comments);
          },
      .write_surface =
          [](std::ostream& out, const Surface& surface, const WriteOptions& o) {
            write_surface_ply(out, surface, o.ascii, o.comments);
          },
      .write_mesh = [](std::ostream& out, const TetMesh& mesh,
                       const WriteOptions& o) { write_body_ply(out, mesh, o.ascii, o.comments); }};
  return format;
}

}  // namespace hapsim
