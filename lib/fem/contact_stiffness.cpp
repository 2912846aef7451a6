#include "fem/contact_stiffness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fem/elastic_body.h"

namespace hapsim {

int PlanGrid::cell(const Vec3& p) const {
  const int c = std::clamp(static_cast<int>(std::floor((p.x() - x0) / step_x)), 0, columns - 1);
  const int r = std::clamp(static_cast<int>(std::floor((p.y() - y0) / step_y)), 0, rows - 1);
  return r * columns + c;
}

Vec3 PlanGrid::centre(int cell) const {
  return {x0 + (cell % columns + 0.5) * step_x, y0 + (cell / columns + 0.5) * step_y, 0};
}

PlanGrid plan_grid(const Surface& surface, int cells_along) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.vertices) box.extend(p);
  PlanGrid grid;
  const Vec3 size = box.sizes();
  const double step = std::max(size.x(), size.y()) / cells_along;
  grid.columns = std::max(1, static_cast<int>(std::ceil(size.x() / step - 1e-9)));
  grid.rows = std::max(1, static_cast<int>(std::ceil(size.y() / step - 1e-9)));
  grid.x0 = box.min().x();
  grid.y0 = box.min().y();
  grid.step_x = size.x() / grid.columns;
  grid.step_y = size.y() / grid.rows;
  return grid;
}

namespace {
constexpr Dilatation kDilatation = Dilatation::kElement;  // soft tissue is nearly incompressible
}

struct ContactBodies::Level {
  ContactMesh contact;
  std::unique_ptr<ElasticBody> body;

  Level(const ContactBase& base, const Vec3& point, double radius, double rim_edge, double growth)
      : contact(make_contact_mesh(base, point, radius, rim_edge, growth)) {
    std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
    for (const int n : contact.patch_nodes) handle[n] = 0;
    body = std::make_unique<ElasticBody>(contact.mesh, handle, kDilatation);
  }
};

ContactBodies::ContactBodies(const ContactBase& base, const Vec3& contact, double radius,
                             double rim_edge)
    : base_(base), contact_(contact), radius_(radius), rim_edge_(rim_edge) {}

ContactBodies::~ContactBodies() = default;

ContactBodies::Level& ContactBodies::level(int k) {
  if (!levels_[k]) {
    const double factor = k == 0 ? 1 : kCoarser;
    levels_[k] = std::make_unique<Level>(base_, contact_, radius_, factor * rim_edge_ * radius_,
                                         factor * kGrowth * rim_edge_ / kRimEdge);
  }
  return *levels_[k];
}

namespace {

struct LevelSolution {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d dK_dnu = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Matrix3d> by_group;
  std::vector<float> share;
};

LevelSolution solve_level(const TetMesh& mesh, ElasticBody& body, const Vec3& normal,
                          const Material& material, const PlanGrid& grid) {
  const std::size_t tets = mesh.tets.size();
  std::vector<int> group(tets, 0);
  std::vector<Vec3> centroid(tets);
  std::vector<Lame> constants(tets);
  const Lame unit = lame(1, material.nu), by_nu = lame_by_poisson(1, material.nu);
  for (std::size_t t = 0; t < tets; ++t) {
    const auto& n = mesh.tets[t];
    centroid[t] = (mesh.nodes[n[0]] + mesh.nodes[n[1]] + mesh.nodes[n[2]] + mesh.nodes[n[3]]) / 4;
    if (material.group_of) group[t] = material.group_of(centroid[t]);
    const double modulus = material.modulus[group[t]];
    constants[t] = {modulus * unit.lambda, modulus * unit.mu};
  }
  body.factorise(constants);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> fields =
      body.solve(Eigen::Matrix3d::Identity()).field;

  LevelSolution solution;
  solution.by_group.assign(material.modulus.size(), Eigen::Matrix3d::Zero());
  std::vector<double> share(static_cast<std::size_t>(grid.columns) * grid.rows, 0);
  double total = 0;
  for (std::size_t t = 0; t < tets; ++t) {
    const ElementEnergies e = element_energies(mesh, t, fields, kDilatation);
    const double modulus = material.modulus[group[t]];
    const Eigen::Matrix3d k = unit.lambda * e.volumetric + unit.mu * e.deviatoric;
    solution.by_group[group[t]] += k;
    solution.K += modulus * k;
    solution.dK_dnu += modulus * (by_nu.lambda * e.volumetric + by_nu.mu * e.deviatoric);
    const double energy = modulus * normal.dot(k * normal);
    if (!share.empty()) share[grid.cell(centroid[t])] += energy;
    total += energy;
  }
  for (const double s : share) solution.share.push_back(static_cast<float>(s / total));
  return solution;
}

}  // namespace

StiffnessSolution ContactBodies::solve(const Material& material, const PlanGrid& grid) {
  const ContactMesh& fine = level(0).contact;
  const LevelSolution f = solve_level(fine.mesh, *level(0).body, fine.normal, material, grid);
  const LevelSolution c =
      solve_level(level(1).contact.mesh, *level(1).body, fine.normal, material, grid);
  StiffnessSolution solution;
  solution.K = f.K;
  solution.dK_dnu = f.dK_dnu;
  solution.dK_dmodulus = f.by_group;
  solution.coarse_change = c.K - f.K;
  solution.point = fine.point;
  solution.normal = fine.normal;
  solution.plan_share = f.share;
  return solution;
}

double mesh_uncertainty(const StiffnessSolution& s) {
  // The error of the finer mesh is up to 0.7 of what the coarser one adds; the 0.3 % is what both
  // have in common (bench_contact_accuracy).
  constexpr double kShare = 0.7, kCommon = 0.003;
  return kCommon +
         kShare * std::abs(s.normal.dot(s.coarse_change * s.normal)) / s.normal.dot(s.K * s.normal);
}

StiffnessSolution ContactBodies::solve_corrected(const Material& material, const PlanGrid& grid,
                                                 const Eigen::Matrix3d& unit,
                                                 const Eigen::Matrix3d& unit_by_nu) {
  Level& coarse = level(1);
  const Vec3& normal = coarse.contact.normal;
  const LevelSolution h =
      solve_level(coarse.contact.mesh, *coarse.body, normal, {material.nu, {1.0}, nullptr}, grid);
  const LevelSolution m = solve_level(coarse.contact.mesh, *coarse.body, normal, material, grid);
  // S = L L_c^-1 from the Cholesky factors of both homogeneous stiffnesses, so S K_c S' = K.
  const Eigen::Matrix3d L = unit.llt().matrixL(), L_c = h.K.llt().matrixL();
  const Eigen::Matrix3d S = L * L_c.inverse();
  const auto corrected = [&](const Eigen::Matrix3d& k) {
    return Eigen::Matrix3d(S * k * S.transpose());
  };
  StiffnessSolution solution;
  solution.K = corrected(m.K);
  // S changes with nu as well, by what the homogeneous body shows.
  solution.dK_dnu =
      corrected(m.dK_dnu) + solution.K.trace() / unit.trace() * (unit_by_nu - corrected(h.dK_dnu));
  for (const Eigen::Matrix3d& k : m.by_group) solution.dK_dmodulus.push_back(corrected(k));
  solution.coarse_change = m.K - solution.K;
  solution.point = coarse.contact.point;
  solution.normal = normal;
  solution.plan_share = m.share;
  return solution;
}

}  // namespace hapsim
