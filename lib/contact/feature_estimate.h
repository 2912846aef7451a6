// What a feature does to a contact's stiffness, estimated without solving the featured body.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "contact/share_tree.h"
#include "material/body_features.h"
#include "mesh/surface_tree.h"
#include "solid/body_regions.h"
#include "solid/element_moments.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {

// The featured body's stiffness is K = L G L', L the Cholesky factor of the homogeneous body's. To
// first order in the feature, from the homogeneous body's unit fields alone, and kept within
// reason beyond that:
// - layer and inclusion: G = exp(log(ratio) S), S the share of the zone in the energy (the sum of
//   L^-1 k L^-T over its elements): the geometric mean lies between the bounds of Voigt and Reuss;
// - transverse isotropy: the energy of the unit fields under the new law (Voigt's bound);
// - tension of the surface: its energy in the same fields (a bound of that kind);
// - growth of a region of the body's labels: none;
// - support: each bonded face gives in series with a column of the body as long as the contact is
//   high above the base.
class FeatureEstimate {
 public:
  // Solves the homogeneous body of this Poisson's ratio on the mesh, once, and shares the mesh.
  // Error(kNoConvergence) when the body is not held.
  FeatureEstimate(std::shared_ptr<const ContactMesh> contact, const SurfaceTree& free_surface,
                  double poisson_ratio);

  struct Change {
    Eigen::Matrix3d G;                      // the identity where the feature does nothing
    std::vector<Eigen::Matrix3d> by_value;  // over the value's unit
  };
  Change at(const BodyFeature& feature) const;
  // Shares of the homogeneous body's energy in regions 0 to `count` - 1, a mean over directions.
  std::vector<double> shares(const BodyRegions& labels, std::size_t count) const;
  std::size_t held_bytes() const {  // the mesh with it
    return hapsim::held_bytes(contact_) + hapsim::held_bytes(tree_) + hapsim::held_bytes(shallow_) +
           hapsim::held_bytes(base_);
  }

 private:
  Change of_zone(const Eigen::Matrix3d& share, const std::vector<Eigen::Matrix3d>& share_by,
                 double ratio) const;
  Change of_layer(const BodyFeature& layer) const;
  Change of_ball(const BodyFeature& ball) const;
  Change of_law(const BodyFeature& transverse) const;
  Change of_support(const BodyFeature& support) const;
  void tabulate_depths(const SurfaceTree& free_surface, const std::vector<Eigen::Matrix3d>& share);
  void make_base(const std::vector<Eigen::Matrix3d>& reaction);

  struct BaseFace {
    Vec3 centre;                 // from the middle of the base [m]
    double size = 0;             // [m], of the edge's smear over it
    Eigen::Matrix3d compliance;  // R' C R for a bed of 1 m
  };

  std::shared_ptr<const ContactMesh> contact_;
  const TetMesh& mesh_;                   // of the contact
  double nu_, height_ = 0;                // [m] of the contact over the base
  Eigen::Matrix3d inverse_;               // L^-1
  ShareTree tree_;                        // of S; the sum of all is the identity
  double deepest_ = 0;                    // [m]
  std::vector<Eigen::Matrix3d> shallow_;  // share of what is nearer to the surface than a thickness
  FieldMoments moments_;                  // of the whole body
  Eigen::Matrix3d tension_ = Eigen::Matrix3d::Zero();  // of a unit one [1/m]
  std::vector<BaseFace> base_;
};

}  // namespace hapsim
