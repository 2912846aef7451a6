// Points and triangle surfaces, and their reading and writing.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/stream.h"

namespace hapsim {

using Triangle = std::array<int, 3>;

struct PointCloud {
  std::vector<Vec3> points;   // [m]
  std::vector<Vec3> normals;  // unit, outward; empty or as many as points
};

// Triangles counter-clockwise seen from outside.
struct Surface {
  std::vector<Vec3> vertices;  // [m]
  std::vector<Triangle> faces;
};

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

// Sum of signed tetrahedra with the origin [m^3]: positive when closed and outward.
double signed_volume(const Surface& surface);
double surface_area(const Surface& surface);
// Cross-product normal of a face, length twice its area.
Vec3 face_normal(const Surface& surface, int face);
// True when every edge has exactly two faces, of opposite direction.
bool is_closed(const Surface& surface);

// The point of the surface nearest to p, its face and distance.
struct SurfacePoint {
  Vec3 point;
  int face = -1;
  double distance = 0;
};
// O(faces); for many points see surface_tree.h.
SurfacePoint nearest_point(const Surface& surface, const Vec3& p);

}  // namespace hapsim
