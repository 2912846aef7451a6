// The stiffness of a body with features against a bonded tool, on one mesh.
#pragma once

#include <memory>
#include <vector>

#include "contact/contact_stiffness.h"
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
    Eigen::Matrix3d K;                                     // [N/m]
    Eigen::Matrix3d by_nu;                                 // [N/m]
    std::vector<Eigen::Matrix3d> by_modulus;               // [m], one a group
    std::vector<std::vector<Eigen::Matrix3d>> by_feature;  // as the features' values
  };
  // Exact derivatives from the energies of the three unit fields. Error(kNoConvergence) when the
  // body is not held.
  Solution solve(const Material& material);
  // Gives back the matrix that is kept for the next solution (some 40 MB).
  void forget_system() { system_.reset(); }
  // That matrix; not the mesh, nor the surface.
  std::size_t held_bytes() const { return hapsim::held_bytes(system_); }

 private:
  struct Moduli;  // by element, with derivatives
  Moduli moduli(const Material& material) const;
  const ContactMesh& contact_;
  std::shared_ptr<const SurfaceTree> free_surface_;
  std::unique_ptr<NodeSystem> system_;
  bool supported_ = false;  // the bonded nodes are free in it
};

}  // namespace hapsim
