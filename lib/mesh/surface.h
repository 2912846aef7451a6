// Points and triangle surfaces.
#pragma once

#include <array>
#include <vector>

#include "base/vec3.h"

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
