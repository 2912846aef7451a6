// One second-order mesh for one contact position, graded to the rim of the tool's flat patch.
#pragma once

#include "mesh/tetmesh.h"
#include "repair/coarsen.h"

namespace hapsim {

// The boundary of a body, closed and outward; class 1: bonded to the support, all corners of the
// face are held. Error(kBadInput) when it does not pass check_surface().
ClassedSurface body_boundary(const TetMesh& body);

// What stays the same for all contact positions of a body: its closed outer surface, coarsened
// where that does not change its shape, with the faces that are bonded to the support marked.
struct ContactBase {
  Surface surface;                       // closed, outward
  std::vector<std::uint8_t> fixed_face;  // one a face: bonded
  Surface fine;                          // the boundary before coarsening: contacts are laid on it
  std::vector<std::uint8_t> fine_fixed;  // one a face of that: bonded
};

// From the body's own boundary: edge collapse (Lindstrom-Turk) to about `edge` [m] (0: a ninth of
// the cube root of three times the volume), finer where the surface bends, never moving the outline
// of the bonded part except where it runs straight; longer edges are split. The volume stays within
// 0.25 %.
ContactBase make_contact_base(const ClassedSurface& boundary, double edge = 0);
ContactBase make_contact_base(const TetMesh& body, double edge = 0);

struct ContactMesh {
  TetMesh mesh;                  // order 2
  std::vector<int> patch_nodes;  // all nodes (corners and middles) under the flat patch
  Vec3 point;                    // contact point projected on the surface
  Vec3 normal;                   // outward unit normal of the patch
  double patch_area = 0;         // [m^2], close to pi radius^2
  bool follows_inner = false;    // elements end at surfaces inside the body (contact_mesh_around.h)
  std::size_t held_bytes() const {
    return hapsim::held_bytes(mesh) + hapsim::held_bytes(patch_nodes);
  }
};

// Imprints the disc of `radius` (a regular polygon of its area) about the surface point nearest to
// `contact` into the surface, with rim edges of length `rim_edge`, grades the surface and the
// volume away from the rim (element size = rim_edge + growth * distance), coarsens the base far
// from it (edges up to growth * distance, 0.4 at most; another 0.25 % of the volume) and meshes the
// inside: with radius / 6 about 3,000 elements on a smooth body, 6,000 on one as rough as 1 %.
// The middles of the edges that end at the rim lie at their quarter points. Same input, same bytes;
// thread-safe. Error(kBadInput) when the contact lies farther than 3 radii (at least 10 mm) from
// the surface or the patch meets the bonded part. A tool that covers the whole body compresses it:
// plates_mesh.h.
ContactMesh make_contact_mesh(const ContactBase& base, const Vec3& contact, double radius,
                              double rim_edge, double growth = 0.4);

}  // namespace hapsim
