// A block of tetrahedra for tests: hexahedra cut into six, with corners moved at random if asked.
#pragma once

#include <algorithm>
#include <map>

#include "base/random.h"
#include "mesh/tetmesh.h"

namespace hapsim::test {

// nx x ny x nz hexahedra over [0, size]; interior corners move by up to `jitter` of a cell.
inline TetMesh block_mesh(const Vec3& size, int nx, int ny, int nz, int order, double jitter = 0) {
  TetMesh mesh;
  Random random(7);
  const auto index = [&](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        Vec3 p(size.x() * i / nx, size.y() * j / ny, size.z() * k / nz);
        const bool inside = i > 0 && i < nx && j > 0 && j < ny && k > 0 && k < nz;
        if (inside)
          for (int c = 0; c < 3; ++c)
            p[c] += jitter * (2 * random.uniform() - 1) * size[c] /
                    (c == 0   ? nx
                     : c == 1 ? ny
                              : nz);
        mesh.nodes.push_back(p);
      }
  constexpr int kPaths[6][2] = {{1, 2}, {2, 1}, {1, 4}, {4, 1}, {2, 4}, {4, 2}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (const auto& path : kPaths) {
          const auto corner = [&](int bits) {
            return index(i + (bits & 1), j + ((bits >> 1) & 1), k + ((bits >> 2) & 1));
          };
          std::array<int, 10> tet;
          tet.fill(-1);
          tet[0] = corner(0);
          tet[1] = corner(path[0]);
          tet[2] = corner(path[0] | path[1]);
          tet[3] = corner(7);
          mesh.tets.push_back(tet);
          if (tet_volume(mesh, mesh.tets.size() - 1) < 0)
            std::swap(mesh.tets.back()[1], mesh.tets.back()[2]);
        }
  mesh.region.assign(mesh.tets.size(), 0);
  mesh.fixed.assign(mesh.nodes.size(), 0);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) mesh.fixed[n] = mesh.nodes[n].z() == 0;
  // Boundary faces: those that one tetrahedron has alone, outward.
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<std::array<int, 3>, std::pair<int, Triangle>> faces;
  for (const auto& tet : mesh.tets)
    for (const auto& f : kFaces) {
      const Triangle t{tet[f[0]], tet[f[1]], tet[f[2]]};
      std::array<int, 3> key = t;
      std::sort(key.begin(), key.end());
      auto& entry = faces[key];
      ++entry.first;
      entry.second = t;
    }
  for (const auto& [key, entry] : faces)
    if (entry.first == 1) mesh.faces.push_back(entry.second);
  return order == 1 ? mesh : to_second_order(mesh);
}

}  // namespace hapsim::test
