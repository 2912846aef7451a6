// The smooth pieces that a scan falls into between its sharp edges.
#pragma once

#include <memory>
#include <vector>

#include "mesh/local_plane.h"
#include "mesh/point_index.h"
#include "mesh/surface.h"

namespace hapsim {

// One piece and the surface through its points: a plane where the points bear that out, else local
// quadratic fits (moving least squares).
class Patch {
 public:
  explicit Patch(PointCloud cloud);  // with outward normals
  Patch(Patch&&) noexcept;
  ~Patch();

  // Height of p over the patch's surface [m], outward positive, and the surface's outward unit
  // normal there. Beside its points the surface is continued.
  struct Height {
    double value = 0;
    Vec3 normal = Vec3::UnitZ();
  };
  Height height(const Vec3& p) const;
  // From p to the nearest point of the patch [m].
  double distance_to_points(const Vec3& p) const;

  const std::vector<Vec3>& points() const { return cloud_->points; }
  bool planar() const { return planar_; }
  std::size_t size() const { return cloud_->points.size(); }
  double noise() const { return noise_; }  // rms height of the points over the surface [m]

 private:
  Height local_height(const Vec3& p) const;

  std::unique_ptr<PointCloud> cloud_;  // where index_ looks, also after a move
  std::unique_ptr<PointIndex> index_;
  bool planar_ = false;
  LocalPlane plane_;
  double noise_ = 0;
};

struct Segmentation {
  std::vector<Patch> patches;
  std::vector<int> patch_of;  // of each point; -1: none
};

// Region growing over normals that do not blur at edges (each point takes the plane of the
// neighbourhood that contains it and is flattest: Kuwahara's filter), pieces that meet at less than
// `crease_deg` joined again, crumbs given to the piece whose surface they lie on. `spacing`:
// distance of neighbouring points [m]. The cloud needs outward normals.
Segmentation find_patches(const PointCloud& cloud, double spacing, double crease_deg);

}  // namespace hapsim
