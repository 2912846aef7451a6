// A block that stands for a half-space under a contact of radius 1.
#pragma once

#include "support/block_mesh.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim::test {

// 2 far x 2 far x depth, bonded at its base, the contact about the origin on its top; the mesh is
// graded to the contact's border, which faces follow, with edges of `rim` there.
inline ContactMesh half_space(double rim, double far, double depth) {
  const ContactBase base = make_contact_base(block_mesh({2 * far, 2 * far, depth}, 8, 8, 4, 1));
  ContactMesh contact = make_contact_mesh(base, {far, far, depth}, 1, rim, 2.4 * rim);
  for (Vec3& p : contact.mesh.nodes) p -= Vec3(far, far, depth);
  return contact;
}
inline ContactMesh half_space(double rim, double far = 80) {
  return half_space(rim, far, far);
}

}  // namespace hapsim::test
