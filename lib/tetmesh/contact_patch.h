// Steps of make_contact_mesh(): the tool's frame, the hole cut for it, the graded patch that fills
// it.
#pragma once

#include <optional>
#include <vector>

#include "repair/coarsen.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {

// The base as one contact needs it: what the tool's force feels of a place falls with its distance,
// so edges may grow with that, to the lesser of `growth` and 0.4 of it. Nor are they much longer:
// on a body a hundred radii wide, one of whose triangles is larger than all that the tool feels,
// the stiffness was 1 to 13 % too high.
ClassedSurface surface_about(const ContactBase& base, const Vec3& contact, double radius,
                             double growth);

// Frame of the contact: origin on the surface, third axis the outward normal of the patch.
struct ContactFrame {
  Vec3 origin, axis_u, axis_v, normal;
  Vec3 to_local(const Vec3& p) const;  // (u, v, height over the tangent plane)
  Vec3 to_global(const Vec3& p) const;
};

// About the point of the fine surface nearest to `contact`. The normal is the area-weighted mean
// over the surface within `spread` of that point, on its side of the body.
ContactFrame contact_frame(const Surface& fine, const Vec3& contact, double spread);

// The connected faces of the coarse surface about the frame's origin that look up, in plan.
struct ContactRegion {
  std::vector<std::uint8_t> inside;  // one a face of the coarse surface
  std::vector<int> loop;             // its boundary, counter-clockwise: vertices of that surface
  std::vector<Vec3> outline;         // the same in the frame
  bool contains(double u, double v, double clearance) const;  // in plan
};

// Faces that come within `reach` of the origin and are tilted against the normal by less than
// `tilt_deg`, never bonded ones. Nothing when they do not form one simple disc with `clear` around
// the origin free of its boundary.
std::optional<ContactRegion> contact_region(const ClassedSurface& coarse, const ContactFrame& frame,
                                            double reach, double tilt_deg, double clear);

// Heights of a surface over the tangent plane, of the sheet that contains the origin.
class HeightMap {
 public:
  // Fine surface where it can be had, else the faces of the coarse region.
  HeightMap(const Surface& fine, const Surface& coarse, const ContactFrame& frame,
            const ContactRegion& region);
  double at(double u, double v) const;

 private:
  struct Facet {
    Vec3 a, b, c;  // in the frame
  };
  static std::optional<double> height(const Facet& facet, double u, double v);
  std::vector<Facet> fine_, coarse_;
};

// Element size grows linearly from the rim: shells of radius `distance[k]` about the rim with
// element size `size[k]`; the first is the rim itself, distance 0.
struct Grading {
  std::vector<double> distance, size;
};
Grading rim_grading(double rim_edge, double growth, double largest_distance, double largest_size);

constexpr int kOther = 1, kBonded = 2, kPatch = 3;  // face markers

// The coarse surface with the region replaced by rings of nodes about the disc of `radius`.
struct Imprint {
  Surface surface;
  std::vector<int> marker;  // one a face
};
Imprint imprint_disc(const ClassedSurface& coarse, const ContactFrame& frame,
                     const ContactRegion& region, const HeightMap& heights, double radius,
                     const Grading& grading);

// Nodes on half-tori below the rim, inside the body and clear of its surface.
std::vector<Vec3> rim_seeds(const Surface& surface, const ContactFrame& frame,
                            const HeightMap& heights, double radius, const Grading& grading,
                            double depth);

}  // namespace hapsim
