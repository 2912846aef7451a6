// A contact mesh solved for a material without features, from the energies of its three unit
// fields.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/contact_stiffness.h"
#include "solid/elastic_body.h"

namespace hapsim {

// Soft tissue is nearly incompressible: elements that do not lock.
constexpr Dilatation kContactDilatation = Dilatation::kElement;

struct LevelSolution {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();       // [N/m]
  Eigen::Matrix3d dK_dnu = Eigen::Matrix3d::Zero();  // [N/m]
  std::vector<Eigen::Matrix3d> by_group;             // over the modulus [m]
  std::vector<float> share;                          // of the energy of a normal press, by cell
};

// `fields`: displacements by the tool's unit displacements, solved for `material` (3 nodes x 3).
LevelSolution level_by_energies(const TetMesh& mesh,
                                const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields,
                                const Vec3& normal, const Material& material, const PlanGrid& grid);
// The same, `body` of the mesh factorised for the material first.
LevelSolution solve_level(const TetMesh& mesh, ElasticBody& body, const Vec3& normal,
                          const Material& material, const PlanGrid& grid);

}  // namespace hapsim
