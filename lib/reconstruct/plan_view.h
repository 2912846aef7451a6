// Plan view of a scan: its outline, triangles inside it and heights over them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

using Vec2 = Eigen::Vector2d;

// The simple polygon, counter-clockwise, about the points' plan view: what a disc of `reach` [m]
// cannot enter from outside (alpha shape), gaps inside filled, its largest part, smoothed, with
// vertices about `edge` [m] apart.
std::vector<Vec2> plan_outline(const std::vector<Vec3>& points, double reach, double edge);

// Even triangles of about `edge` [m] inside the polygon, z = 0, upward. The vertices on the polygon
// come first, `rim` of them, counter-clockwise; the mesher may add some to it. Delaunay refinement
// by CGAL.
Surface plan_mesh(const std::vector<Vec2>& outline, double edge, int& rim);

// Heights of the plan's vertices: least squares to the points (Tukey weights) plus the squared
// Laplacian (cotangent weights, so that planes cost nothing), weighed by five-fold
// cross-validation.
std::vector<double> fit_heights(const Surface& plan, const std::vector<Vec3>& points);

}  // namespace hapsim
