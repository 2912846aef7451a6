#include "contact/level_solution.h"

namespace hapsim {
namespace {

std::size_t group_of(const TetMesh& mesh, std::size_t tet, const Material& material) {
  return material.group_of ? static_cast<std::size_t>(material.group_of(tet_centroid(mesh, tet)))
                           : 0;
}

}  // namespace

LevelSolution level_by_energies(const TetMesh& mesh,
                                const Eigen::Matrix<double, Eigen::Dynamic, 3>& fields,
                                const Vec3& normal, const Material& material,
                                const PlanGrid& grid) {
  const Lame unit = lame(1, material.nu), by_nu = lame_by_poisson(1, material.nu);
  LevelSolution solution;
  solution.by_group.assign(material.modulus.size(), Eigen::Matrix3d::Zero());
  std::vector<double> share(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  double total = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const ElementEnergies e = element_energies(mesh, t, fields, kContactDilatation);
    const std::size_t group = group_of(mesh, t, material);
    const double modulus = material.modulus[group];
    const Eigen::Matrix3d k = unit.lambda * e.volumetric + unit.mu * e.deviatoric;
    solution.by_group[group] += k;
    solution.K += modulus * k;
    solution.dK_dnu += modulus * (by_nu.lambda * e.volumetric + by_nu.mu * e.deviatoric);
    const double energy = modulus * normal.dot(k * normal);
    if (!share.empty()) share[grid.cell(tet_centroid(mesh, t))] += energy;
    total += energy;
  }
  for (const double s : share) solution.share.push_back(static_cast<float>(s / total));
  return solution;
}

LevelSolution solve_level(const TetMesh& mesh, ElasticBody& body, const Vec3& normal,
                          const Material& material, const PlanGrid& grid) {
  const Lame unit = lame(1, material.nu);
  std::vector<Lame> constants;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double modulus = material.modulus[group_of(mesh, t, material)];
    constants.push_back({modulus * unit.lambda, modulus * unit.mu});
  }
  body.factorise(constants);
  return level_by_energies(mesh, body.solve(Eigen::Matrix3d::Identity()).field, normal, material,
                           grid);
}

}  // namespace hapsim
