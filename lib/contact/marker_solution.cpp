#include "contact/marker_solution.h"

#include "contact/element_groups.h"
#include "contact/surface_place.h"
#include "solid/elastic_body.h"

namespace hapsim {
namespace {

// Nearly incompressible tissue must not lock (contact_stiffness.cpp).
constexpr Dilatation kWithoutLocking = Dilatation::kElement;

// Adds -dK U of one element, whose constants change by `by`, to the columns from `first` on.
void add_change(const TetMesh& mesh, std::size_t tet, const Lame& by, const Eigen::MatrixXd& fields,
                Eigen::Index first, Eigen::MatrixXd& load) {
  const ElementStiffness element(mesh, tet, by, kWithoutLocking);
  for (int a = 0; a < 10; ++a) {
    const auto na = 3 * static_cast<Eigen::Index>(mesh.tets[tet][static_cast<std::size_t>(a)]);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int b = 0; b < 10; ++b) {
      const auto nb = 3 * static_cast<Eigen::Index>(mesh.tets[tet][static_cast<std::size_t>(b)]);
      sum.noalias() += element.block(a, b) * fields.block<3, 3>(nb, 0);
    }
    load.block<3, 3>(na, first) -= sum;
  }
}

// The field's three columns from `first` on, at the places.
std::vector<Eigen::Matrix3d> field_at(const std::vector<SurfacePlace>& places,
                                      const Eigen::MatrixXd& field, Eigen::Index first) {
  std::vector<Eigen::Matrix3d> values;
  for (const SurfacePlace& place : places) {
    Eigen::Matrix3d value = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < 6; ++k)
      value +=
          place.weight[k] * field.block<3, 3>(3 * static_cast<Eigen::Index>(place.node[k]), first);
    values.push_back(value);
  }
  return values;
}

}  // namespace

MarkerSolution solve_markers(const ContactMesh& contact, const Material& material,
                             const std::vector<Vec3>& points) {
  const TetMesh& mesh = contact.mesh;
  std::vector<int> handle(mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact.patch_nodes) handle[static_cast<std::size_t>(n)] = 0;
  const Lame unit = lame(1, material.nu), by_nu = lame_by_poisson(1, material.nu);
  const ElementGroups element(mesh, material, contact.follows_inner);
  std::vector<Lame> constants;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double modulus = element.modulus(t, material.modulus);
    constants.push_back({modulus * unit.lambda, modulus * unit.mu});
  }
  ElasticBody body(mesh, handle, kWithoutLocking);
  body.factorise(constants);
  const Eigen::MatrixXd fields = body.solve(Eigen::Matrix3d::Identity()).field;

  const std::size_t groups = material.modulus.size();
  const bool apart = groups > 1;
  Eigen::MatrixXd load =
      Eigen::MatrixXd::Zero(fields.rows(), 3 + (apart ? 3 * static_cast<Eigen::Index>(groups) : 0));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double modulus = element.modulus(t, material.modulus);
    add_change(mesh, t, {modulus * by_nu.lambda, modulus * by_nu.mu}, fields, 0, load);
    if (!apart) continue;
    element.for_each(t, [&](std::size_t g, double share) {
      const double by = share * (modulus / material.modulus[g]);
      add_change(mesh, t, {by * unit.lambda, by * unit.mu}, fields,
                 3 + 3 * static_cast<Eigen::Index>(g), load);
    });
  }
  const Eigen::MatrixXd slopes = body.relax(load);
  const std::vector<SurfacePlace> places = surface_places(mesh, points);
  MarkerSolution s;
  s.G = s.coarse_G = field_at(places, fields, 0);
  s.dG_dnu = field_at(places, slopes, 0);
  for (std::size_t g = 0; g < groups; ++g)
    s.dG_dmodulus.push_back(
        apart ? field_at(places, slopes, 3 + 3 * static_cast<Eigen::Index>(g))
              : std::vector<Eigen::Matrix3d>(points.size(), Eigen::Matrix3d::Zero()));
  return s;
}

StiffnessSolution packed(const MarkerSolution& s) {
  StiffnessSolution entry{};
  entry.K = entry.dK_dnu = entry.coarse_change = entry.coarse_dK_dnu = Eigen::Matrix3d::Zero();
  entry.point = entry.normal = Vec3::Zero();
  entry.dK_dfeature = s.dG_dmodulus;
  entry.dK_dfeature.insert(entry.dK_dfeature.end(), {s.G, s.dG_dnu, s.coarse_G});
  return entry;
}

std::optional<MarkerSolution> unpacked_markers(const StiffnessSolution& entry) {
  const auto& all = entry.dK_dfeature;
  if (all.size() < 4) return std::nullopt;
  for (const auto& values : all)
    if (values.size() != all.back().size()) return std::nullopt;
  MarkerSolution s;
  s.coarse_G = all.back();
  s.dG_dnu = all[all.size() - 2];
  s.G = all[all.size() - 3];
  s.dG_dmodulus.assign(all.begin(), all.end() - 3);
  return s;
}

}  // namespace hapsim
