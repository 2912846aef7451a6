// Points and triangle surfaces read and written.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "io/stream.h"
#include "mesh/surface.h"

namespace hapsim {

// By content: PLY with faces (polygons as fans), or STL (equal corners are merged, faces without
// area dropped). Vertices that no face uses are dropped. Error(kBadInput) otherwise.
Surface read_surface(Input& input);
// The same, but vertices that no face uses and faces with two equal corners are kept.
Surface read_surface_as_given(Input& input);
// By content: PLY vertices (faces ignored), CSV with x,y,z[,nx,ny,nz], or rows of numbers without a
// header (x y z [nx ny nz]). Error(kBadInput): no points, NaN or text in a coordinate.
PointCloud read_points(Input& input);

// Points or triangles, whichever the bytes hold: a PLY with faces or an STL gives `surface`, as it
// was given, anything else `cloud`.
struct Shape {
  bool has_triangles = false;
  Surface surface;
  PointCloud cloud;
};
Shape read_shape(Input& input);

void write_surface_ply(std::ostream& out, const Surface& surface, bool ascii = false,
                       const std::vector<std::string>& comments = {});
void write_points_ply(std::ostream& out, const PointCloud& cloud, bool ascii = false,
                      const std::vector<std::string>& comments = {});

}  // namespace hapsim
