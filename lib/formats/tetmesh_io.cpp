// The body file: PLY with tetrahedra.
#include "formats/tetmesh_io.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>

#include "base/error.h"
#include "formats/mesh_file.h"
#include "formats/ply.h"

namespace hapsim {
namespace {

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

// Of each connected part the fixed corners.
std::map<int, std::vector<int>> fixed_by_part(const TetMesh& mesh) {
  std::vector<int> above(mesh.nodes.size());
  std::iota(above.begin(), above.end(), 0);
  const auto root = [&](int n) {
    for (; above[n] != n; n = above[n]) above[n] = above[above[n]];
    return n;
  };
  for (const auto& tet : mesh.tets)
    for (int k = 1; k < 4; ++k) above[root(tet[k])] = root(tet[0]);
  std::map<int, std::vector<int>> fixed;
  for (const auto& tet : mesh.tets) fixed[root(tet[0])];
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n)
    if (const auto part = fixed.find(root(n)); mesh.fixed[n] == 1 && part != fixed.end())
      part->second.push_back(n);
  return fixed;
}

// Three corners that are not on one line hold a body.
bool hold(const TetMesh& mesh, const std::vector<int>& corners) {
  if (corners.size() < 3) return false;
  const Vec3& first = mesh.nodes[corners[0]];
  const auto far = [&](const auto& distance) {
    return *std::max_element(corners.begin(), corners.end(),
                             [&](int a, int b) { return distance(a) < distance(b); });
  };
  const Vec3 line = mesh.nodes[far([&](int n) { return (mesh.nodes[n] - first).norm(); })] - first;
  const auto off_line = [&](int n) { return (mesh.nodes[n] - first).cross(line).norm(); };
  return off_line(far(off_line)) > 1e-6 * line.squaredNorm();
}

}  // namespace

TetMesh read_body(Input& input) {
  const std::string bytes = input.read_all();
  TetMesh mesh = parse_mesh(bytes, input.name(), false).mesh;
  if (std::find(mesh.fixed.begin(), mesh.fixed.end(), 1) == mesh.fixed.end())
    fail_input(input.name(), "no node is fixed: the body would float",
               "mesh with hs-tetmesh --fixed bottom, or set the vertex property 'fixed'");
  for (const auto& [part, fixed] : fixed_by_part(mesh)) {
    if (hold(mesh, fixed)) continue;
    const Vec3& p = mesh.nodes[part];
    fail_input(input.name(),
               fmt::format("the fixed nodes do not hold the part of the body with the node at "
                           "({:.6g}, {:.6g}, {:.6g})",
                           p.x(), p.y(), p.z()),
               "fix three corners or more that are not on one line, or remove the part");
  }
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

}  // namespace hapsim
