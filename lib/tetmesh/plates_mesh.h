// The mesh of a body that is compressed between plates: the tool covers all of it.
#pragma once

#include "tetmesh/contact_mesh.h"

namespace hapsim {

// The patch is the flat face under the tool, all of which moves with it; edges there and at the
// support have a length of `rim_edge` at the faces' outlines and grow by `growth` with the distance
// from these. Same input, same bytes. Error(kBadInput) beginning with `where` when less than 0.7 of
// the body's mean section is flat under the tool: a contact that grows between plates is not
// modelled.
ContactMesh make_plates_mesh(const ContactBase& base, const Vec3& contact, const Vec3& normal,
                             double height, double rim_edge, double growth,
                             const std::string& where);

}  // namespace hapsim
