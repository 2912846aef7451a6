// The bonded faces of a body as springs: Feature::kSupport.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Per unit modulus, and how the springs change with the feature's three values. A face that the
// edge cuts takes part of both sides by the area of each, so forces follow the edge without steps,
// with continuous derivatives, as if the mesh did.
struct SupportSprings {
  struct Face {
    std::vector<int> nodes;
    Eigen::MatrixXd matrix;          // for a spring of 1 [1/m]
    double spring = 0;               // [1/m]
    std::array<double, 3> by_value;  // of the spring
  };
  std::vector<Face> faces;

  SupportSprings(const TetMesh& mesh, const std::vector<double>& value);
};

}  // namespace hapsim
