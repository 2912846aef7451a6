#include "simulate/own_mesh.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.h"
#include "experiment/forces.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "formats/field_vtu.h"
#include "material/maxwell_memory.h"
#include "mesh/between_plates.h"
#include "simulate/regional_relaxation.h"

namespace hapsim {
namespace {

MaterialSpec checked_material(const Model& model) {
  MaterialSpec material = material_of(model);
  if (!material.features.empty() || material.shift.norm() > 0 || material.rotation.norm() > 0)
    fail_input(model.name, "the model has an effect that the body's own mesh cannot show",
               "simulate without --own-mesh: each contact then has a mesh that can");
  return material;
}

std::vector<Lame> constants(const TetMesh& mesh, const MaterialSpec& material) {
  const Lame unit = lame(1, material.nu);
  std::vector<Lame> result;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double modulus =
        material.local
            ? 1
            : material.modulus[static_cast<std::size_t>(region_of_tet(material, mesh, t))];
    result.push_back({modulus * unit.lambda, modulus * unit.mu});
  }
  return result;
}

std::vector<MeshPatch> patches(const TetMesh& mesh, const std::vector<Vec3>& positions,
                               double radius) {
  std::vector<MeshPatch> result;
  for (const Vec3& p : positions) result.push_back(patch_under_tool(mesh, p, radius));
  return result;
}

std::vector<double> gains(const MaterialSpec& material, const std::vector<Vec3>& positions) {
  std::vector<double> result;
  for (const Vec3& p : positions)
    result.push_back(material.local ? local_modulus(material, p).value : 1);
  return result;
}

// What the tool did until a sample: its displacement and each Maxwell element's memory of it.
struct Memory {
  Vec3 u = Vec3::Zero();
  std::vector<Vec3> h;
};

Memory memory_at(const PressView& view, const std::vector<MaxwellTerm>& terms, std::size_t at) {
  Memory memory{view.in_air[0] ? Vec3(Vec3::Zero()) : view.u[0], {}};
  memory.h.assign(terms.size(), memory.u);
  for (std::size_t i = 1; i <= at; ++i) {
    const Vec3 u = view.in_air[i] ? Vec3(Vec3::Zero()) : view.u[i];
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const double dt = view.t.empty() ? 0 : view.t[i] - view.t[i - 1];
      const MemoryStep s = memory_step(dt, terms[k].tau);
      memory.h[k] = s.a * memory.h[k] + s.c * (u - memory.u);
    }
    memory.u = u;
  }
  return memory;
}

}  // namespace

OwnMesh::OwnMesh(const TetMesh& mesh, const Model& model, const std::vector<Vec3>& positions,
                 double tool_radius, SolverKind solver)
    : mesh_(mesh),
      model_(model),
      material_(checked_material(model)),
      tool_radius_(tool_radius),
      lame_(constants(mesh, material_)),
      press_(mesh, patches(mesh, positions, tool_radius), solver),
      solutions_(press_.solve(lame_)) {
  gain_ = gains(material_, positions);
  const std::vector<RegionRelaxation> regions = regional_relaxation_of(model, material_);
  if (regions.empty()) {
    for (std::size_t p = 0; p < positions.size(); ++p)
      stiffness_.push_back({gain_[p] * solutions_[p].K, {}, {}});
    return;
  }
  const auto solve = [&](const MaterialSpec& material) {
    const std::vector<double> gain = gains(material, positions);
    std::vector<Eigen::Matrix3d> K;
    for (const MeshPress::Solution& s : press_.solve(constants(mesh, material)))
      K.push_back(gain[K.size()] * s.K);
    return K;
  };
  double misfit = 0;
  stiffness_ = regional_stiffness(regions, material_, solve, misfit);
}

std::vector<ToolStand> OwnMesh::stands() const {
  const Surface surface = boundary_surface(mesh_);
  std::vector<ToolStand> result;
  for (const MeshPatch& p : press_.patches())
    result.push_back({p.normal, height_between_plates(surface, p.point, p.normal, tool_radius_)});
  return result;
}

std::vector<int> OwnMesh::labels() const {
  std::vector<Vec3> points;
  for (const MeshPatch& p : press_.patches()) points.push_back(p.point);
  return labels_at(BodyRegions::of(mesh_), points);
}

std::size_t OwnMesh::patch_size(std::size_t position) const {
  return press_.patches()[position].nodes.size();
}

// The mean over the element, by Hooke's law from the mean strain.
Eigen::Matrix3d OwnMesh::unit_stress(std::size_t tet, const Eigen::Matrix<double, 3, 10>& u) const {
  const ElementGradients e = element_gradients(mesh_, tet);
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  double volume = 0;
  for (int q = 0; q < e.points; ++q) {
    gradient += e.weight[q] * u.leftCols(e.nodes) * e.gradient[q].leftCols(e.nodes).transpose();
    volume += e.weight[q];
  }
  gradient /= volume;
  Eigen::Matrix3d stress = lame_[tet].mu * (gradient + gradient.transpose());
  stress.diagonal().array() += lame_[tet].lambda * gradient.trace();
  return stress;
}

void OwnMesh::write_field(std::ostream& out, const Episode& episode, std::size_t at) const {
  if (is_regional())
    fail_input(model_.name, "the field of regions that relax each in its own way is not written",
               "leave out --vtu, or give all of them the terms of region 0");
  refuse_other_than_relaxation(model_, "the field of the body");
  const std::vector<MaxwellTerm> terms = relaxation_of(model_, material_).common;
  const Memory memory = memory_at(episode.view, terms, at);
  const auto position = static_cast<std::size_t>(episode.position);
  const Eigen::MatrixXd& field = solutions_[position].field;
  const double gain = gain_[position];
  Vec3 acting = memory.u;  // what stress follows
  for (std::size_t k = 0; k < terms.size(); ++k) acting += terms[k].share * memory.h[k];
  const Eigen::VectorXd moved = field * memory.u, strained = field * acting;

  std::vector<double> displacement(moved.data(), moved.data() + moved.size());
  std::vector<double> stress, energy;
  const int count = mesh_.order == 1 ? 4 : 10;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    Eigen::Matrix<double, 3, 10> u = Eigen::Matrix<double, 3, 10>::Zero();
    for (int a = 0; a < count; ++a)
      u.col(a) = strained.segment<3>(3 * static_cast<Eigen::Index>(mesh_.tets[t][a]));
    const Eigen::Matrix3d s = gain * unit_stress(t, u);
    for (const double value : {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)})
      stress.push_back(value);
    const ElementEnergies e = element_energies(mesh_, t, field, press_.dilatation());
    const Eigen::Matrix3d D = lame_[t].lambda * e.volumetric + lame_[t].mu * e.deviatoric;
    double twice = memory.u.dot(D * memory.u);
    for (std::size_t k = 0; k < terms.size(); ++k)
      twice += terms[k].share * memory.h[k].dot(D * memory.h[k]);
    energy.push_back(0.5 * gain * twice / tet_volume(mesh_, t));
  }
  write_field_vtu(out, mesh_, {{"displacement", 3, std::move(displacement)}},
                  {{"stress", 6, std::move(stress)}, {"energy_density", 1, std::move(energy)}});
}

}  // namespace hapsim
