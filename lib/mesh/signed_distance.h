// How far a point is from a body's surface, and on which side.
#pragma once

#include <vector>

#include "mesh/surface_tree.h"

namespace hapsim {

// The nearest point of the surface, as a contact needs it.
struct SurfaceSide {
  Vec3 point;           // on the surface [m]
  Vec3 normal;          // outward, unit; of the face, edge or corner on which `point` lies
  double distance = 0;  // positive outside, negative inside [m]
  int face = -1;        // a triangle that contains `point`
};

// Signed distance to a closed outward surface. Its sign is right everywhere, also where the nearest
// point lies on an edge or corner: the normal there is the angle-weighted mean of the faces that
// meet in it (Baerentzen and Aanaes, IEEE Trans. Visualization and Computer Graphics 11(3), 2005).
// Queries allocate nothing, throw nothing and are thread-safe.
class SignedDistance {
 public:
  // A surface that check_surface() passes; Error(kBadInput) beginning with `where` otherwise.
  explicit SignedDistance(Surface surface, const std::string& where = "surface");
  // `hint`: the face of the last query of a moving point, -1 for none.
  SurfaceSide at(const Vec3& p, int hint = -1) const noexcept;
  // The same on the connected sheet about `face`: walks from that face to neighbours as long as
  // they are nearer. It does not jump to the far side of a thin body when p lies deep inside.
  SurfaceSide along(const Vec3& p, int face) const noexcept;
  const Surface& surface() const { return tree_.surface(); }
  const Vec3& vertex_normal(int vertex) const { return vertex_normal_[vertex]; }  // unit, outward

 private:
  SurfaceSide side(const Vec3& p, int face) const noexcept;

  SurfaceTree tree_;
  std::vector<Vec3> face_normal_;
  std::vector<std::array<Vec3, 3>> edge_normal_;  // after corners 0, 1, 2 of each face
  std::vector<Vec3> vertex_normal_;
  std::vector<int> first_around_;  // faces about vertex v: around_[first_around_[v] .. [v + 1])
  std::vector<int> around_;
};

}  // namespace hapsim
