// TetGen in a process of its own: private to tetgen*.cpp.
#pragma once

#include <string>
#include <vector>

#include "tetmesh/tetgen.h"

namespace hapsim {

struct TetgenAnswer {
  std::string failure;  // why there is no mesh; empty when there is one
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 10>> tets;  // corners in TetGen's turn, then -1
  std::vector<Triangle> faces;            // of all surfaces, either turn
  std::vector<int> marker;                // one a face
};

// Has a worker mesh, streams the arrays back into their place. Error(kIo): no process or socket.
TetgenAnswer run_tetgen_child(const TetgenInput& input, const TetgenOptions& options);

}  // namespace hapsim
