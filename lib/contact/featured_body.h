// The stiffness of a body with features against a bonded tool, on one mesh.
#pragma once

#include <memory>
#include <vector>

#include "contact/contact_stiffness.h"
#include "contact/element_groups.h"
#include "material/body_features.h"
#include "mesh/surface_tree.h"
#include "solid/node_system.h"

namespace hapsim {

// Solves one contact mesh for any material. Not to be shared between threads.
class FeaturedBody {
 public:
  // `free_surface`: the outer surface without its bonded part. Mesh and surface must outlive it.
  FeaturedBody(const ContactMesh& contact, std::shared_ptr<const SurfaceTree> free_surface);
  ~FeaturedBody();

  struct Solution {
    Eigen::Matrix3d K;      // [N/m]
    Eigen::Matrix3d by_nu;  // [N/m]
    // What the mixtures of elements that a boundary cuts may err by: their energies times
    // (L + L^2) / 4, L = log(A / H) between their bounds in parallel and in series. It covers what
    // was measured of balls and sheets of 0.01 to 100 times the modulus around them
    // (bench/regions/small.py) [N/m].
    Eigen::Matrix3d mixed;
    std::vector<Eigen::Matrix3d> by_modulus;               // [m], one a group
    std::vector<std::vector<Eigen::Matrix3d>> by_feature;  // as the features' values
  };
  // Exact derivatives from the energies of the three unit fields. Error(kNoConvergence) when the
  // body is not held.
  Solution solve(const Material& material);
  // Gives back the matrix that is kept for the next solution (some 40 MB), but not the order in
  // which it is eliminated (some 30 kB), which takes longer to find than to use.
  void forget_system();
  // That matrix, or its order; not the mesh, nor the surface.
  std::size_t held_bytes() const {
    return hapsim::held_bytes(system_) + hapsim::held_bytes(order_) + hapsim::held_bytes(groups_);
  }

 private:
  std::shared_ptr<const ElementGroups> groups(const Material& material);
  const ContactMesh& contact_;
  std::shared_ptr<const SurfaceTree> free_surface_;
  std::shared_ptr<const ElementGroups> groups_;  // of the last material with labels
  std::shared_ptr<const BodyRegions> labels_;    // these
  std::unique_ptr<NodeSystem> system_;
  std::vector<int> order_;      // of the system that was given back
  bool supported_ = false;      // the bonded nodes are free in it, or were
  std::size_t face_terms_ = 0;  // of features on faces, in it
};

}  // namespace hapsim
