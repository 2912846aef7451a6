// Bodies inside a body: where a point lies, as a function whose zero is the boundary.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "mesh/surface.h"
#include "mesh/surface_tree.h"

namespace hapsim {

// Negative inside, positive outside, in metres near the boundary; with its derivatives by the
// boundary's parameters (length as the level set says).
struct LevelValue {
  double value = 0;
  Eigen::VectorXd by_parameters;
  double clear = 0;  // the boundary is at least so far away [m]
};
using LevelSet = std::function<LevelValue(const Vec3&)>;

// Ray counting (Shimrat, Commun. ACM 5, 1962; Jordan's theorem): a ray from the point crosses the
// boundary an odd number of times when the point is inside. Points on the boundary may fall on
// either side.
bool inside_polygon(const std::vector<Vec3>& polygon, const Vec3& p);  // plan view, z ignored
// `closed`: any closed triangle surface; the ray is turned when it meets an edge. Error(kBadInput)
// when every turned ray does (a surface that is not closed or has no area).
bool inside_polyhedron(const Surface& closed, const Vec3& p);

// All level sets below may be called from several threads.

// Inside a polygon in plan view, through the whole depth: distance to its outline. Parameters
// x0, y0, x1, y1, ... of its corners. Error(kBadInput): fewer than three corners.
LevelSet polygon_level(const std::vector<Vec3>& polygon);
// Inside a closed surface: distance to it. One parameter: growth along its normals [m].
LevelSet polyhedron_level(const Surface& closed);
// Nearer to the surface than `thickness` [m]: a skin. One parameter: the thickness.
LevelSet layer_level(const Surface& surface, double thickness);
LevelSet layer_level(std::shared_ptr<const SurfaceTree> surface, double thickness);
// Inside an ellipsoid whose semi-axes [m] lie along x, y, z: (q - 1) / |grad q|, to first order the
// distance. Parameters: centre x, y, z, semi-axes a, b, c. Error(kBadInput): a semi-axis not
// positive.
LevelSet ellipsoid_level(const Vec3& centre, const Vec3& semi_axes);

}  // namespace hapsim
