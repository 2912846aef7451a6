// What a mesh read from a file must fulfil, and what is mended.
#include "formats/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "formats/format_table.h"
#include "mesh/support.h"
#include "mesh/tet_faces.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "mesh the surface again with hs-tetmesh";

std::string place(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

// Exchanges the corners 2 and 3, and the middles of 12 and 13, 02 and 03.
void turn(std::array<int, 10>& t) {
  std::swap(t[2], t[3]);
  std::swap(t[5], t[8]);
  std::swap(t[6], t[7]);
}

void check_shapes(TetMesh& mesh, bool mend, MeshRepairs& repairs, const std::string& where) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double v = tet_volume(mesh, t), least = least_volume(mesh, t);
    if (v > least) continue;
    if (!(v < -least))
      fail_input(where,
                 fmt::format("tetrahedron {} at {} is flat", t, place(tet_centroid(mesh, t))),
                 kMend);
    if (!mend)
      fail_input(where,
                 fmt::format("tetrahedron {} at {} is inverted", t, place(tet_centroid(mesh, t))),
                 "run hs-tetmesh on this file, which turns such");
    turn(mesh.tets[t]);
    ++repairs.turned;
  }
}

// A file of another node order puts middles on other edges.
void check_middles(const TetMesh& mesh, const std::string& where) {
  if (mesh.order != 2) return;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int e = 0; e < 6; ++e) {
      const auto& n = mesh.tets[t];
      const Vec3 &a = mesh.nodes[n[kTetEdges[e][0]]], &b = mesh.nodes[n[kTetEdges[e][1]]];
      const Vec3& m = mesh.nodes[n[4 + e]];
      if ((m - 0.5 * (a + b)).squaredNorm() > 0.16 * (a - b).squaredNorm())
        fail_input(where,
                   fmt::format("tetrahedron {} at {}: its node {} is not near the middle of the "
                               "edge it belongs to",
                               t, place(tet_centroid(mesh, t)), 4 + e),
                   "check the order of the ten nodes");
    }
}

void drop_doubled(TetMesh& mesh, MeshRepairs& repairs) {
  std::vector<std::pair<std::array<int, 4>, std::size_t>> sorted;
  sorted.reserve(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<int, 4> corners;
    std::copy_n(mesh.tets[t].begin(), 4, corners.begin());
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint8_t> drop(mesh.tets.size(), 0);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first) {
      drop[sorted[i].second] = 1;
      ++repairs.doubled;
    }
  if (repairs.doubled == 0) return;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (drop[t] != 0) continue;
    mesh.tets[kept] = mesh.tets[t];
    mesh.region[kept++] = mesh.region[t];
  }
  mesh.tets.resize(kept);
  mesh.region.resize(kept);
}

void check_faces(const TetMesh& mesh, const std::string& where) {
  visit_faces(mesh, [&](std::size_t tet, int face, int tets) {
    if (tets < 3) return;
    const Triangle f = face_of(mesh, tet, face);
    fail_input(
        where,
        fmt::format("the face at {} has {} tetrahedra",
                    place((mesh.nodes[f[0]] + mesh.nodes[f[1]] + mesh.nodes[f[2]]) / 3), tets),
        kMend);
  });
}

// A node of no tetrahedron would leave the stiffness singular.
void drop_unused_nodes(TetMesh& mesh, MeshRepairs& repairs) {
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
  repairs.unused_nodes = number.size() - used;
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

// All nodes of the given triangles, middles too.
void fix_listed_faces(TetMesh& mesh, std::vector<Triangle> fixed) {
  const auto ascending = [](Triangle f) {
    std::sort(f.begin(), f.end());
    return f;
  };
  for (Triangle& f : fixed) f = ascending(f);
  std::sort(fixed.begin(), fixed.end());
  std::vector<std::uint8_t> chosen;
  for (const Triangle& f : mesh.faces)
    chosen.push_back(std::binary_search(fixed.begin(), fixed.end(), ascending(f)));
  for (const int n : nodes_of_faces(mesh, chosen)) mesh.fixed[n] = 1;
}

MeshFile finished(RawMesh& raw, const std::string& where, bool mend) {
  MeshFile file;
  file.format = raw.format;
  file.repairs.other_cells = raw.other_cells;
  TetMesh& mesh = file.mesh;
  if (raw.tets.empty())
    fail_input(where, "there is no tetrahedron",
               raw.other_cells > 0 ? "only tetrahedra are read: split the other cells first"
                                   : "give a mesh of tetrahedra, or mesh a surface by hs-tetmesh");
  if (raw.other_cells > 0)
    fail_input(
        where,
        fmt::format("{} cells of the volume are no tetrahedra of 4 or 10 nodes", raw.other_cells),
        "mesh it with tetrahedra alone");
  mesh.order = raw.order;
  mesh.nodes = std::move(raw.nodes);
  mesh.tets = std::move(raw.tets);
  mesh.region = std::move(raw.region);
  mesh.faces = std::move(raw.faces);
  file.has_fixed = !raw.fixed.empty() || !raw.fixed_faces.empty();
  mesh.fixed = std::move(raw.fixed);
  mesh.fixed.resize(mesh.nodes.size(), 0);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (!mesh.nodes[n].allFinite())
      fail_input(where, fmt::format("node {} is not finite", n), kMend);
  check_shapes(mesh, mend, file.repairs, where);
  check_middles(mesh, where);
  if (mend) drop_doubled(mesh, file.repairs);
  if (mend) check_faces(mesh, where);
  // Inner faces in a file would be taken for the boundary: it is found anew when mending.
  if (mend || mesh.faces.empty()) mesh.faces = boundary_faces(mesh);
  if (!raw.fixed_faces.empty() && std::count(mesh.fixed.begin(), mesh.fixed.end(), 1) == 0)
    fix_listed_faces(mesh, std::move(raw.fixed_faces));
  drop_unused_nodes(mesh, file.repairs);
  return file;
}

}  // namespace

bool RawMesh::add(const int* corners, std::size_t count, int number_of_region) {
  const int its = count == 4 ? 1 : 2;
  if (order != 0 && order != its) return false;
  order = its;
  auto& t = tets.emplace_back();
  t.fill(-1);
  std::copy_n(corners, count, t.begin());
  region.push_back(number_of_region);
  return true;
}

MeshFile parse_mesh(const std::string& bytes, const std::string& where, bool mend) {
  const Recognised found = recognise(bytes);
  if (found.format == nullptr || found.format->read_mesh == nullptr)
    fail_format(where, bytes, Content::kTetrahedra, "write it with hs-tetmesh");
  RawMesh raw = found.format->read_mesh(bytes, where);
  return finished(raw, where, mend);
}

}  // namespace hapsim
