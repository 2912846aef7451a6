// From the points of a scan to points that can be trusted: no doubles, no gross outliers.
#pragma once

#include <string>
#include <vector>

#include "mesh/surface.h"
#include "reconstruct/merge_points.h"

namespace hapsim {

struct CleanOptions {
  bool remove_outliers = true;
  double spacing = 0;  // of merged points [m]; 0: as a surface asks for (merge_points())
};

// What was done, for the summary.
struct CleanReport {
  std::size_t read = 0;
  std::size_t duplicates = 0;       // equal to an earlier point
  std::size_t near_duplicates = 0;  // closer than a thousandth of the usual distance to one
  std::size_t isolated = 0;         // far from all others, compared with its neighbours
  std::size_t off_surface = 0;      // off the plane of its neighbours
  MergeReport merged;
  std::size_t kept = 0;
  std::vector<int> index;  // index[i]: number in the input of kept point i (the nearest of those
                           // merged)
  std::size_t thinned() const { return merged.before - merged.after; }
};

// Distance of neighbours were the points laid out evenly, 1/sqrt(points a unit area): from the
// median distance to the sixth neighbour [m].
double point_spacing(const std::vector<Vec3>& points);

// Removes points equal to an earlier one, merges those that lie denser than a surface asks for, and
// removes of what is left what else CleanReport counts, in that order; what is kept keeps its
// order. Error(kBadInput, name): fewer than 4 points, or all on a line.
PointCloud clean_points(const PointCloud& cloud, const CleanOptions& options,
                        const std::string& name, CleanReport& report);

// One point a cubic cell of `size` [m]: the mean of its points and (renormalised) normals, in the
// order in which the cells are first met.
PointCloud thin_points(const PointCloud& cloud, double size);

// Fails as clean_points does.
void require_surface_points(const std::vector<Vec3>& points, const std::string& name);

}  // namespace hapsim
