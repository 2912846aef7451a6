// The body file: PLY with tetrahedra.
#include <algorithm>
#include <cstdint>

#include "base/error.h"
#include "geometry/mesh_file.h"
#include "io/ply.h"

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

}  // namespace

TetMesh read_body(Input& input) {
  const std::string bytes = input.read_all();
  TetMesh mesh = parse_mesh(bytes, input.name(), false).mesh;
  if (std::find(mesh.fixed.begin(), mesh.fixed.end(), 1) == mesh.fixed.end())
    fail_input(input.name(), "no node is fixed: the body would float",
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

}  // namespace hapsim
