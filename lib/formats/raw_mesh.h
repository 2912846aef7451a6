// What a reader of a mesh format gives, before it is checked and mended.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// A mesh as a file has it: indices are within range, nothing else is checked.
struct RawMesh {
  std::string format;
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 10>> tets;
  std::vector<int> region;          // empty: 0
  std::vector<std::uint8_t> fixed;  // empty: not said
  std::vector<Triangle> faces;      // empty: the boundary
  std::vector<Triangle> fixed_faces;
  int order = 0;  // 0: no tetrahedron yet
  std::size_t other_cells = 0;

  // Adds a tetrahedron of `count` corners; false when its order is not that of the others.
  bool add(const int* corners, std::size_t count, int number_of_region);
};

}  // namespace hapsim
