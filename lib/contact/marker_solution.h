// How points of a body's surface move when a bonded flat tool moves its patch.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "contact/contact_stiffness.h"

namespace hapsim {

// A point moves by G u where the tool moves by u. Young's modulus drops out of G [-] of a
// homogeneous body, a common factor of the moduli of any. In the frame of the body; by point.
struct MarkerSolution {
  std::vector<Eigen::Matrix3d> G, dG_dnu;
  std::vector<std::vector<Eigen::Matrix3d>> dG_dmodulus;  // [group][point] [1/Pa]
  std::vector<Eigen::Matrix3d> coarse_G;                  // of the coarser mesh
  std::size_t held_bytes() const {
    return hapsim::held_bytes(G) + hapsim::held_bytes(dG_dnu) + hapsim::held_bytes(dG_dmodulus) +
           hapsim::held_bytes(coarse_G);
  }
};

// Of a material without features, on one mesh; that mesh's values stand for the coarser one's too.
// With the fields U of unit moves, K_ff dU = -dK U: three more right-hand sides of the same
// factorisation for Poisson's ratio and for each group but where there is one. Interpolated by the
// shape functions of the surface's elements. Error(kNoConvergence) as ElasticBody.
MarkerSolution solve_markers(const ContactMesh& contact, const Material& material,
                             const std::vector<Vec3>& points);

// As an entry of the cache of stiffnesses, and back; nothing where the entry is of something else.
StiffnessSolution packed(const MarkerSolution& solution);
std::optional<MarkerSolution> unpacked_markers(const StiffnessSolution& entry);

}  // namespace hapsim
