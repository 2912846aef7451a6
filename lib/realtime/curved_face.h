// The smooth surface that a triangle stands for.
#pragma once

#include "mesh/signed_distance.h"

namespace hapsim {

// Its height [m] over a point of a face, along `normal` (unit, the corners' normals interpolated;
// given back). The cubic through the corners with their normals (curved PN triangle: Vlachos,
// Peters, Boyd and Mitchell, I3D 2001): a mesh has its nodes on the real surface and cuts the way
// between them short, by a twelfth of the edge squared over the radius on average. An end of an
// edge that leaves its tangent plane by more than 25 degrees is a crease, and straight.
double curved_height(const SignedDistance& surface, int face, const Vec3& point, Vec3& normal);

}  // namespace hapsim
