// A contact mesh whose elements end at surfaces inside the body.
#pragma once

#include <vector>

#include "tetmesh/contact_mesh.h"

namespace hapsim {

// As make_contact_mesh(), with closed outward surfaces inside the body, clear of its own surface
// and of each other, kept as faces between tetrahedra. Error(kBadInput), with what TetGen says,
// where they are not clear.
ContactMesh make_contact_mesh_around(const ContactBase& base, const Vec3& contact, double radius,
                                     double rim_edge, double growth,
                                     const std::vector<Surface>& inner);

// Closed outward surfaces inside the body with edges as long as the mesh about a contact has them
// there, finer where they bend. Error(kBadInput) when one is no manifold.
std::vector<Surface> inner_about(const std::vector<Surface>& inner, const Vec3& contact,
                                 double radius, double growth);

}  // namespace hapsim
