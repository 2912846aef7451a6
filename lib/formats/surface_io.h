// Points and triangle surfaces read, in any format of the table, and written as PLY.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "io/stream.h"
#include "mesh/surface.h"

namespace hapsim {

// By content (formats/format_table.h): triangles, polygons as fans, or the boundary of a mesh.
// Equal corners of an STL are merged, faces with two equal corners and vertices that no face uses
// dropped. Error(kBadInput) otherwise.
Surface read_surface(Input& input);
Surface parse_surface(const std::string& bytes, const std::string& name);
// By content: points, or the corners of triangles (faces ignored). `notes` gets what was left out,
// in words. Error(kBadInput): no points, NaN or text in a coordinate.
PointCloud read_points(Input& input);
PointCloud parse_points(const std::string& bytes, const std::string& name,
                        std::vector<std::string>* notes = nullptr);

// Points or triangles, whichever the bytes hold: triangles (of a mesh of tetrahedra its boundary)
// give `surface`, vertices that no face uses and faces with two equal corners are kept; anything
// else gives `cloud`.
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
