// The body file of hapsim: PLY with the element tetrahedron.
#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "formats/mesh_parts.h"
#include "formats/ply.h"

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

}  // namespace

RawMesh parse_ply_mesh(const std::string& bytes, const std::string& where) {
  const PlyFile file = parse_ply(bytes, where);
  RawMesh mesh;
  mesh.format = "PLY";
  read_nodes(file, where, mesh);
  read_tets(file, where, mesh);
  read_faces(file, where, mesh);
  return mesh;
}

}  // namespace hapsim
