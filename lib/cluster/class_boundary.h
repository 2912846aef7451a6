// Where a classifier of the plane changes from one class to another.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace hapsim {

using PlaneClassifier = std::function<int(const Eigen::Vector2d&)>;  // -1: outside the domain

// One connected piece of the boundary between classes a < b; closed when the first point is
// repeated at the end.
struct BoundaryLine {
  int a = 0, b = 0;
  std::vector<Eigen::Vector2d> points;
};

// The boundaries within the box from scan points (thesis 5.2.4): labels on a grid of about
// `scan_points` points, cells cut into triangles, crossings of their edges found by bisection to
// 1/1000 of a cell; where three classes meet in a triangle, their lines meet at its middle. Lines
// are ordered by a, b, then from the longest.
std::vector<BoundaryLine> class_boundaries(const PlaneClassifier& classify,
                                           const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                                           int scan_points);

double length(const BoundaryLine& line);

// `count` points (at least 2) evenly along a line, its ends among them.
std::vector<Eigen::Vector2d> key_points(const BoundaryLine& line, int count);

// Distance of a point from the nearest segment of the lines; infinite when there are none.
double distance_to(const std::vector<BoundaryLine>& lines, const Eigen::Vector2d& point);

}  // namespace hapsim
