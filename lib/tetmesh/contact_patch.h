// Steps of make_contact_mesh(): the tool's frame, the hole cut for it, the graded patch that fills
// it.
#pragma once

#include <array>
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
// over the surface within `spread` of that point, on its side of the body: it turns steadily as the
// point nears an edge.
ContactFrame contact_frame(const Surface& fine, const Vec3& contact, double spread);

// A piece of surface about the frame's origin laid out flat, as a sheet is that wraps it: a point
// lies in the direction that it has in the tangent plane, as far from the origin as in space. Where
// the way there, the section through the normal, crosses creases, it is as far as it is from crease
// to crease, so that what falls off steeply behind one is not squeezed.
class SheetPlan {
 public:
  void add_crease(const Vec3& a, const Vec3& b) { creases_.push_back({a, b}); }
  bool has_creases() const { return !creases_.empty(); }
  const std::vector<std::array<Vec3, 2>>& creases() const { return creases_; }
  Eigen::Vector2d of(const Vec3& local) const;
  // The last crease before `distance` in this direction (a unit vector): where the way crosses it,
  // in the frame, and how far it lies along that way; none: the origin, 0.
  struct Start {
    Vec3 point = Vec3::Zero();
    double way = 0;
  };
  Start start(const Eigen::Vector2d& direction, double distance) const;

 private:
  std::vector<Start> crossings(const Eigen::Vector2d& direction) const;
  std::vector<std::array<Vec3, 2>> creases_;  // in the frame
};

// The connected faces of the coarse surface about the frame's origin that look up.
struct ContactRegion {
  std::vector<std::uint8_t> inside;  // one a face of the coarse surface
  std::vector<int> loop;             // its boundary, counter-clockwise: vertices of that surface
  SheetPlan plan;                    // creases are the sharp edges inside
  std::vector<Eigen::Vector2d> outline;                       // the loop in plan
  bool contains(double u, double v, double clearance) const;  // in plan
};

// Faces that come within `reach` of the origin and are tilted against the normal by less than
// `tilt_deg`, never bonded ones. Nothing when they do not form one simple disc with `clear` around
// the origin free of its boundary.
std::optional<ContactRegion> contact_region(const ClassedSurface& coarse, const ContactFrame& frame,
                                            double reach, double tilt_deg, double clear);

// The sheet of a surface that contains the origin, by its plan.
class SheetMap {
 public:
  struct Spot {
    Vec3 point, normal;  // in the frame; outward, unit, of the coarse region
  };
  // Fine surface where it can be had, else the faces of the coarse region.
  SheetMap(const Surface& fine, const Surface& coarse, const ContactFrame& frame,
           const ContactRegion& region);
  Spot at(double u, double v) const;
  bool has_creases() const { return plan_.has_creases(); }

 private:
  struct Facet {
    Vec3 a, b, c, normal;  // in the frame
  };
  static Facet facet(const Surface& surface, std::size_t f, const ContactFrame& frame);
  SheetPlan plan_;
  std::vector<Facet> fine_, coarse_;
};

// Element size grows linearly from the rim: shells of radius `distance[k]` about the rim with
// element size `size[k]`; the first is the rim itself, distance 0.
struct Grading {
  std::vector<double> distance, size;
};
Grading rim_grading(double rim_edge, double growth, double largest_distance, double largest_size);

// Nodes along the creases of a region, in plan, as far apart as the grading has them, and the ways
// of the creases themselves in short steps. Where a crease crosses the rim there is a node.
struct CreaseNodes {
  std::vector<Eigen::Vector2d> free, on_rim, way;
  double distance(const Eigen::Vector2d& p) const;  // from the creases
};
CreaseNodes crease_nodes(const ContactRegion& region, double rim, const Grading& grading);

constexpr int kOther = 1, kBonded = 2, kPatch = 3;  // face markers

// The coarse surface with the region replaced by rings of nodes about the disc of `radius`.
struct Imprint {
  Surface surface;
  std::vector<int> marker;  // one a face
};
Imprint imprint_disc(const ClassedSurface& coarse, const ContactFrame& frame,
                     const ContactRegion& region, const SheetMap& sheet, double radius,
                     const Grading& grading);

// Nodes on half-tori below the rim, inside the body and clear of its surface, and of each other
// where the tool lies over an edge.
std::vector<Vec3> rim_seeds(const Surface& surface, const ContactFrame& frame,
                            const SheetMap& sheet, double radius, const Grading& grading,
                            double depth);

}  // namespace hapsim
