#include "contact/contact_stiffness.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "contact/feature_estimate.h"
#include "contact/featured_body.h"
#include "contact/level_solution.h"
#include "contact/marker_solution.h"
#include "contact/tool_torque_solution.h"
#include "solid/elastic_body.h"
#include "solid/poisson_sweep.h"
#include "tetmesh/contact_mesh_around.h"

namespace hapsim {

int PlanGrid::cell(const Vec3& p) const {
  const int c = std::clamp(static_cast<int>(std::floor((p.x() - x0) / step_x)), 0, columns - 1);
  const int r = std::clamp(static_cast<int>(std::floor((p.y() - y0) / step_y)), 0, rows - 1);
  return r * columns + c;
}

Vec3 PlanGrid::centre(int cell) const {
  const int row = cell / columns, column = cell % columns;
  return {x0 + (column + 0.5) * step_x, y0 + (row + 0.5) * step_y, 0};
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
// Of boundaries that a contact's mesh follows: each brings some ten elements with it.
constexpr std::size_t kMostInnerFaces = 1500;
}  // namespace

struct ContactBodies::Level {
  std::shared_ptr<const ContactMesh> shared;
  const ContactMesh& contact;
  std::unique_ptr<ElasticBody> homogeneous;  // made when first asked for
  std::vector<double> nus;                   // of the sweep
  std::unique_ptr<PoissonSweep> unit;

  explicit Level(ContactMesh mesh)
      : shared(std::make_shared<const ContactMesh>(std::move(mesh))), contact(*shared) {}

  std::size_t held_bytes() const {
    return hapsim::held_bytes(shared) + hapsim::held_bytes(homogeneous) + hapsim::held_bytes(nus) +
           hapsim::held_bytes(unit);
  }

  ElasticBody& body() {
    if (homogeneous) return *homogeneous;
    std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
    for (const int n : contact.patch_nodes) handle[n] = 0;
    homogeneous = std::make_unique<ElasticBody>(contact.mesh, handle, kContactDilatation);
    return *homogeneous;
  }

  const PoissonSweep& sweep(const std::vector<double>& asked) {
    if (!unit || nus != asked) unit = std::make_unique<PoissonSweep>(contact.mesh, body(), asked);
    nus = asked;
    return *unit;
  }
};

std::shared_ptr<const SurfaceTree> free_surface(const ContactBase& base) {
  Surface surface;
  surface.vertices = base.surface.vertices;
  for (std::size_t f = 0; f < base.surface.faces.size(); ++f)
    if (!base.fixed_face[f]) surface.faces.push_back(base.surface.faces[f]);
  return std::make_shared<const SurfaceTree>(std::move(surface));
}

ContactBodies::ContactBodies(const ContactBase& base, const Vec3& contact, double radius,
                             double rim_edge, std::shared_ptr<const SurfaceTree> surface,
                             std::shared_ptr<const std::vector<Surface>> inner)
    : base_(base),
      contact_(contact),
      radius_(radius),
      rim_edge_(rim_edge),
      surface_(std::move(surface)),
      inner_(std::move(inner)) {}

ContactBodies::~ContactBodies() = default;

bool ContactBodies::follows(const Material& material) const {
  return material.labels && inner_ && !inner_->empty() &&
         std::none_of(material.features.begin(), material.features.end(),
                      [](const BodyFeature& f) { return f.kind == Feature::kGrowth; });
}

ContactBodies::Level& ContactBodies::level(int k, bool follow) {
  const bool inner = follow && !cannot_follow_[k];
  std::unique_ptr<Level>& made = levels_[inner ? 1 : 0][k];
  if (made) return *made;
  const double factor = k == 0 ? 1 : k == 1 ? kCoarser : kSampled;
  const double rim = factor * rim_edge_ * radius_, growth = factor * kGrowth * rim_edge_ / kRimEdge;
  if (!inner) {
    made = std::make_unique<Level>(make_contact_mesh(base_, contact_, radius_, rim, growth));
    return *made;
  }
  try {
    const std::vector<Surface> parts = inner_about(*inner_, contact_, radius_, growth);
    std::size_t faces = 0;
    for (const Surface& part : parts) faces += part.faces.size();
    if (faces <= kMostInnerFaces) {
      made = std::make_unique<Level>(
          make_contact_mesh_around(base_, contact_, radius_, rim, growth, parts));
      return *made;
    }
  } catch (const Error& error) {
    if (error.code() == ExitCode::kIo) throw;  // of the machine, not of the boundaries
    // Boundaries too near to each other, the surface or the tool: elements across them will do.
  }
  cannot_follow_[k] = true;
  return level(k, false);
}

StiffnessSolution ContactBodies::solve(const Material& material, const PlanGrid& grid) {
  const ContactMesh& fine = level(0).contact;
  const LevelSolution f = solve_level(fine.mesh, level(0).body(), fine.normal, material, grid);
  const LevelSolution c =
      solve_level(level(1).contact.mesh, level(1).body(), fine.normal, material, grid);
  StiffnessSolution solution;
  solution.K = f.K;
  solution.dK_dnu = f.dK_dnu;
  solution.dK_dmodulus = f.by_group;
  solution.coarse_change = c.K - f.K;
  solution.coarse_dK_dnu = c.dK_dnu;
  solution.point = fine.point;
  solution.normal = fine.normal;
  solution.plan_share = f.share;
  return solution;
}

StiffnessSolution ContactBodies::solve_unit(const std::vector<double>& nus, std::size_t which,
                                            const PlanGrid& grid) {
  Level& fine = level(0);
  const PoissonSweep& sweep = fine.sweep(nus);
  const PoissonSweep::Solution f = sweep.at(nus[which]), c = level(1).sweep(nus).at(nus[which]);
  StiffnessSolution solution;
  solution.K = f.K;
  solution.dK_dnu = f.dK_dnu;
  solution.dK_dmodulus = {f.K};
  solution.coarse_change = c.K - f.K;
  solution.coarse_dK_dnu = c.dK_dnu;
  solution.point = fine.contact.point;
  solution.normal = fine.contact.normal;
  if (which == nus.size() / 2) {
    const Material material{nus[which], {1.0}, nullptr};
    solution.plan_share =
        level_by_energies(fine.contact.mesh, sweep.field(), solution.normal, material, grid).share;
  }
  return solution;
}

double mesh_uncertainty(const StiffnessSolution& s) {
  // The error of the finer mesh is up to 0.7 of what the coarser one adds; the 0.3 % is what both
  // have in common (bench_contact_accuracy).
  constexpr double kShare = 0.7, kCommon = 0.003;
  return kCommon +
         kShare * std::abs(s.normal.dot(s.coarse_change * s.normal)) / s.normal.dot(s.K * s.normal);
}

// Of the direction in which they do most: under a thin skin that is sideways, and the normal one
// says nothing of it.
double mixture_uncertainty(const StiffnessSolution& s) {
  if (s.mixed.isZero(0)) return 0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> worst(
      0.5 * (s.mixed + s.mixed.transpose()), 0.5 * (s.K + s.K.transpose()), Eigen::EigenvaluesOnly);
  return worst.eigenvalues()[2];
}

FeaturedBody& ContactBodies::featured(int k, bool follow) {
  if (!surface_) surface_ = free_surface(base_);
  const ContactMesh& contact = level(k, follow).contact;
  auto& made = featured_[contact.follows_inner ? 1 : 0][k];
  if (!made) made = std::make_unique<FeaturedBody>(contact, surface_);
  return *made;
}

SampledContact ContactBodies::sample(const Material& material, ContactLevel which) {
  const int k = static_cast<int>(which);
  Level& own = level(k);
  SampledContact result{own.contact.point, own.contact.normal, Eigen::Matrix3d::Zero()};
  if (material.has_groups() || !material.features.empty()) {
    result.K = featured(k, follows(material)).solve(material).K;
    return result;
  }
  const Lame unit = lame(1, material.nu);
  const double modulus = material.modulus[0];
  ElasticBody& body = own.body();
  body.factorise(
      std::vector<Lame>(own.contact.mesh.tets.size(), {modulus * unit.lambda, modulus * unit.mu}));
  result.K = body.solve(Eigen::Matrix3d::Identity()).reaction;
  return result;
}

TorqueSolution ContactBodies::torque(const Material& material) {
  const bool follow = follows(material);
  TorqueSolution solution = solve_torque(level(0, follow).contact, material);
  const TorqueSolution coarse = solve_torque(level(1, follow).contact, material);
  solution.coarse_K = coarse.K;
  solution.coarse_T = coarse.T;
  return solution;
}

MarkerSolution ContactBodies::markers(const Material& material, const std::vector<Vec3>& points) {
  const bool follow = follows(material);
  MarkerSolution solution = solve_markers(level(0, follow).contact, material, points);
  solution.coarse_G = solve_markers(level(1, follow).contact, material, points).G;
  return solution;
}

void ContactBodies::forget_systems() {
  for (const auto& of_kind : featured_)
    for (const auto& body : of_kind)
      if (body) body->forget_system();
}

std::shared_ptr<const FeatureEstimate> ContactBodies::estimate(double poisson_ratio) {
  if (!surface_) surface_ = free_surface(base_);
  return std::make_shared<const FeatureEstimate>(level(1).shared, *surface_, poisson_ratio);
}

std::size_t ContactBodies::held_bytes() const {
  std::size_t sum = 0;
  for (const auto& of_kind : featured_)
    for (const auto& body : of_kind) sum += hapsim::held_bytes(body);
  for (const auto& of_kind : levels_)
    for (const auto& level : of_kind) sum += hapsim::held_bytes(level);
  return sum;
}

StiffnessSolution ContactBodies::solve_featured(const Material& material) {
  const bool follow = follows(material);
  const FeaturedBody::Solution m = featured(0, follow).solve(material);
  StiffnessSolution solution;
  solution.K = m.K;
  solution.mixed = m.mixed;
  solution.dK_dnu = solution.coarse_dK_dnu = m.by_nu;
  solution.dK_dmodulus = m.by_modulus;
  solution.dK_dfeature = m.by_feature;
  solution.coarse_change.setZero();
  solution.point = level(0, follow).contact.point;
  solution.normal = level(0, follow).contact.normal;
  return solution;
}

StiffnessSolution ContactBodies::solve_corrected(const Material& material, const UnitPair& fine,
                                                 const UnitPair& coarse) {
  const bool follow = follows(material);
  const FeaturedBody::Solution m = featured(1, follow).solve(material);
  const ContactMesh& contact = level(1, follow).contact;
  // S = L L_c^-1 from the Cholesky factors of both homogeneous stiffnesses, so S K_c S' = K.
  const Eigen::Matrix3d L = fine.K.llt().matrixL(), L_c = coarse.K.llt().matrixL();
  const Eigen::Matrix3d S = L * L_c.inverse();
  const auto corrected = [&](const Eigen::Matrix3d& k) {
    return Eigen::Matrix3d(S * k * S.transpose());
  };
  StiffnessSolution solution;
  solution.K = corrected(m.K);
  solution.mixed = corrected(m.mixed);
  // S changes with nu as well, by what the homogeneous body shows.
  solution.dK_dnu = corrected(m.by_nu) +
                    solution.K.trace() / fine.K.trace() * (fine.by_nu - corrected(coarse.by_nu));
  for (const Eigen::Matrix3d& k : m.by_modulus) solution.dK_dmodulus.push_back(corrected(k));
  for (const auto& feature : m.by_feature) {
    solution.dK_dfeature.emplace_back();
    for (const Eigen::Matrix3d& k : feature) solution.dK_dfeature.back().push_back(corrected(k));
  }
  solution.coarse_change = m.K - solution.K;
  solution.coarse_dK_dnu = m.by_nu;
  solution.point = contact.point;
  solution.normal = contact.normal;
  return solution;
}

}  // namespace hapsim
