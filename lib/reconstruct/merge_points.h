// Points of a scan that lie denser than its surface asks for, merged.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Of the noise, the closest spacing that is chosen: what planes through points resolve.
constexpr double kMergeNoises = 5;

// What was merged, for the summary.
struct MergeReport {
  std::size_t before = 0;
  std::size_t after = 0;  // equal to `before`: nothing was
  bool asked = false;     // for this spacing
  double spacing = 0;     // of the merged points, about [m]
  double noise = 0;       // rms distance of a patch's points from its plane, the median [m]; 0: not
                          // needed
};

struct MergedPoints {
  PointCloud cloud;
  std::vector<int> index;  // of the point given that lies nearest; ascending
  std::vector<int> count;  // of the points that were merged
};

// Halves the points across their longest principal axis until no part is longer than `spacing` [m]
// asks (Pauly, Gross, Kobbelt, Efficient simplification of point-sampled surfaces, 2002; halved
// where they reach, not at their mean, so that outliers do not cut the surface in layers); each
// part becomes the mean of its points. So noise falls by the square root of the points merged, in
// columns as deep as the noise, which a grid's cells would cut in layers. On a surface with the
// radius of curvature R the mean lies spacing^2 / (12 R) inside. Normals, where there are any,
// become the mean normal, and points whose normals differ by more than 45 degrees are no one's
// part: edges and thin walls stay. With `spacing` 0 the spacing is the widest of what a hundred
// thousand points take and five times the noise, which is as much as planes through the points
// resolve; where that merges less than a third of the points nothing is done. Time n log n, memory
// 32 bytes a point.
MergedPoints merge_points(const PointCloud& cloud, double spacing, MergeReport& report);

}  // namespace hapsim
