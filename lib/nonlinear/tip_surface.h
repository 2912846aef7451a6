// The surface under a rigid tip, ready for contact tractions.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// Boundary faces that lie with all corners within `reach` of a point and whose normals are within
// 60 degrees of `normal`. Tractions are linear on them: a hat on each corner node.
struct TipSurface {
  struct Point {
    std::size_t face;
    std::array<int, 3> hat;
    std::array<double, 3> corner;  // values of the hats
    std::array<double, 6> shape;   // N of the face's nodes
    double area;                   // share of the area [m^2]
    Vec3 position;
  };
  std::vector<std::vector<int>> faces;  // nodes: 3, or 6 of second order
  std::vector<Point> points;            // quadrature points
  std::vector<char> rim;                // one a hat, 1: on the boundary of these faces
  Eigen::VectorXd area;                 // integral of each hat [m^2]

  // Error(kBadInput): no face in reach.
  TipSurface(const TetMesh& mesh, const Vec3& point, const Vec3& normal, double reach);
};

// Height of a sphere's surface over its lowest point at distance r from its axis, and its slope by
// the radius R; beyond the equator as if the slope there went on.
struct SphereHeight {
  double height = 0, by_radius = 0;
};
SphereHeight sphere_height(double R, double r);

}  // namespace hapsim
