// Contours in parallel sections, as traced in CT or MR slices, to points with normals.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "io/csv.h"
#include "scan/scan.h"

namespace hapsim {

struct Section {
  double z = 0;                                        // [m]
  std::vector<std::vector<Eigen::Vector2d>> contours;  // closed polygons, in either direction
  // Distance of p from the nearest contour [m], negative inside (within an odd number of contours),
  // and its gradient in the plane.
  double distance(const Eigen::Vector2d& p, Eigen::Vector2d* gradient = nullptr) const;
};

// Columns x, y, z (in `unit` metres) and, where there are several in a section, contour; the points
// of a contour in their order along it. Rows of equal z, or of equal `section` where that column
// is, are a section; without z, sections lie `distance` [m] apart in the order of their numbers.
// Sorted by z. Error(kBadInput): fewer than two sections, a contour of fewer than 3 different
// points (with its line), a section at two heights, two sections at one height.
std::vector<Section> read_sections(const CsvTable& table, double unit, double distance);

// The contours' points, and points between sections that lie farther apart than the points along
// the contours, on the surface that shape-based interpolation gives: the signed distances of
// neighbouring sections are interpolated linearly (Raya, Udupa, IEEE Trans. Med. Imag. 9, 1990).
// Normals are that field's gradient. The ends are open.
Scan sections_scan(const std::vector<Section>& sections);

}  // namespace hapsim
