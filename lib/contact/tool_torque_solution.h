// The torque with which a body answers a bonded flat tool that is moved and not turned.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "contact/contact_stiffness.h"

namespace hapsim {

// T u is the moment about the contact's point that keeps the tool from turning while it is moved by
// u, K u the force (StiffnessSolution): the body's torque on the tool is -T u = T K^-1 f, f its
// force on the tool. Young's modulus drops out of the lever T K^-1 [m] of a homogeneous body. In
// the frame of the body.
struct TorqueSolution {
  Eigen::Matrix3d K, T;                                   // [N/m], [N]
  Eigen::Matrix3d dK_dnu, dT_dnu;                         // [N/m], [N]
  std::vector<Eigen::Matrix3d> dK_dmodulus, dT_dmodulus;  // [m], [m^2]: one a group
  Eigen::Matrix3d coarse_K, coarse_T;                     // of the coarser mesh
  std::size_t held_bytes() const {
    return hapsim::held_bytes(dK_dmodulus) + hapsim::held_bytes(dT_dmodulus);
  }
};

// Of a material without features, on one mesh; that mesh's values stand for the coarser one's too.
// T_ij is the bilinear form of the field of a unit turn about axis i and that of a unit move along
// j, so its derivatives are the energies of their strains as those of K are: three more right-hand
// sides, no further factorisation. Error(kNoConvergence) as ElasticBody.
TorqueSolution solve_torque(const ContactMesh& contact, const Material& material);

// As an entry of the cache of stiffnesses, and back; nothing where the entry is of something else.
StiffnessSolution packed(const TorqueSolution& solution);
std::optional<TorqueSolution> unpacked(const StiffnessSolution& entry);

}  // namespace hapsim
