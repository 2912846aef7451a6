// Points of a triangle surface made vertices of it: private to lib/realtime.
#pragma once

#include "mesh/surface.h"

namespace hapsim {

// Weights of the corners of a triangle at a point of its plane; they sum to one.
Vec3 corner_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// Splits `face`, or the two faces at an edge when `p` is nearer to that edge than kOnEdge of the
// triangle; takes the corner that is as near. Gives the vertex. The surface stays closed and
// outward.
constexpr double kOnEdge = 1e-4;
int insert_vertex(Surface& surface, int face, const Vec3& p);

}  // namespace hapsim
