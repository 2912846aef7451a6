#include "contact/tool_torque_solution.h"

#include <array>

#include "contact/element_groups.h"
#include "contact/rigid_stiffness.h"
#include "solid/elastic_body.h"

namespace hapsim {
namespace {

// Nearly incompressible tissue must not lock (contact_stiffness.cpp).
constexpr Dilatation kUnlocked = Dilatation::kElement;

using SixFields = Eigen::Matrix<double, Eigen::Dynamic, 6>;  // three moves, then three turns

// The energies of element_energies() between all six fields: lambda volumetric + mu deviatoric.
struct SixEnergies {
  Matrix6 volumetric = Matrix6::Zero(), deviatoric = Matrix6::Zero();
};

SixEnergies six_energies(const TetMesh& mesh, std::size_t tet, const SixFields& fields) {
  const ElementGradients element = element_gradients(mesh, tet);
  SixEnergies energies;
  Vector6 dilated = Vector6::Zero();
  double volume = 0;
  for (int q = 0; q < element.points; ++q) {
    const double w = element.weight[static_cast<std::size_t>(q)];
    Eigen::Matrix<double, 9, 6> strain;
    Vector6 divergence;
    for (int i = 0; i < 6; ++i) {
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
      for (int a = 0; a < element.nodes; ++a)
        gradient.noalias() +=
            fields.block<3, 1>(3 * mesh.tets[tet][static_cast<std::size_t>(a)], i) *
            element.gradient[static_cast<std::size_t>(q)].col(a).transpose();
      const Eigen::Matrix3d symmetric = 0.5 * (gradient + gradient.transpose());
      strain.col(i) = symmetric.reshaped();
      divergence[i] = gradient.trace();
    }
    energies.deviatoric += 2 * w * strain.transpose() * strain;
    dilated += w * divergence;
    volume += w;
  }
  energies.volumetric = dilated * dilated.transpose() / volume;
  return energies;
}

// Every node of the patch a handle of its own, moved as the tool is.
SixFields unit_fields(const ContactMesh& contact, const std::vector<Lame>& constants) {
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  const auto count = static_cast<Eigen::Index>(contact.patch_nodes.size());
  Eigen::MatrixXd motion(3 * count, 6);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int node = contact.patch_nodes[static_cast<std::size_t>(k)];
    const Vec3 arm = contact.mesh.nodes[static_cast<std::size_t>(node)] - contact.point;
    handle[static_cast<std::size_t>(node)] = static_cast<int>(k);
    motion.block<3, 3>(3 * k, 0).setIdentity();
    for (int axis = 0; axis < 3; ++axis)
      motion.block<3, 1>(3 * k, 3 + axis) = Vec3::Unit(axis).cross(arm);
  }
  ElasticBody body(contact.mesh, handle, kUnlocked);
  body.factorise(constants);
  return body.solve(motion).field;
}

}  // namespace

TorqueSolution solve_torque(const ContactMesh& contact, const Material& material) {
  const TetMesh& mesh = contact.mesh;
  const std::size_t tets = mesh.tets.size();
  const Lame unit = lame(1, material.nu), by_nu = lame_by_poisson(1, material.nu);
  const ElementGroups groups(mesh, material, contact.follows_inner);
  std::vector<Lame> constants(tets);
  for (std::size_t t = 0; t < tets; ++t) {
    const double modulus = groups.modulus(t, material.modulus);
    constants[t] = {modulus * unit.lambda, modulus * unit.mu};
  }
  const SixFields fields = unit_fields(contact, constants);
  std::vector<Matrix6> by_group(material.modulus.size(), Matrix6::Zero());
  Matrix6 all = Matrix6::Zero(), slope = Matrix6::Zero();
  for (std::size_t t = 0; t < tets; ++t) {
    const SixEnergies e = six_energies(mesh, t, fields);
    const double modulus = groups.modulus(t, material.modulus);
    const Matrix6 k = unit.lambda * e.volumetric + unit.mu * e.deviatoric;
    groups.for_each(t, [&](std::size_t g, double share) {
      by_group[g] += share * (modulus / material.modulus[g]) * k;
    });
    all += modulus * k;
    slope += modulus * (by_nu.lambda * e.volumetric + by_nu.mu * e.deviatoric);
  }
  TorqueSolution s;
  s.K = s.coarse_K = all.topLeftCorner<3, 3>();
  s.T = s.coarse_T = all.bottomLeftCorner<3, 3>();
  s.dK_dnu = slope.topLeftCorner<3, 3>();
  s.dT_dnu = slope.bottomLeftCorner<3, 3>();
  for (const Matrix6& k : by_group) {
    s.dK_dmodulus.emplace_back(k.topLeftCorner<3, 3>());
    s.dT_dmodulus.emplace_back(k.bottomLeftCorner<3, 3>());
  }
  return s;
}

StiffnessSolution packed(const TorqueSolution& s) {
  StiffnessSolution entry{};
  entry.K = s.K;
  entry.dK_dnu = s.dK_dnu;
  entry.dK_dmodulus = s.dK_dmodulus;
  entry.coarse_change = s.coarse_K;
  entry.coarse_dK_dnu.setZero();
  entry.point = entry.normal = Vec3::Zero();
  entry.dK_dfeature = {s.dT_dmodulus, {s.T, s.dT_dnu, s.coarse_T}};
  return entry;
}

std::optional<TorqueSolution> unpacked(const StiffnessSolution& entry) {
  const auto& more = entry.dK_dfeature;
  if (more.size() != 2 || more[0].size() != entry.dK_dmodulus.size() || more[1].size() != 3)
    return std::nullopt;
  TorqueSolution s;
  s.K = entry.K;
  s.dK_dnu = entry.dK_dnu;
  s.dK_dmodulus = entry.dK_dmodulus;
  s.coarse_K = entry.coarse_change;
  s.dT_dmodulus = more[0];
  s.T = more[1][0];
  s.dT_dnu = more[1][1];
  s.coarse_T = more[1][2];
  return s;
}

}  // namespace hapsim
