#include "solid/mesh_press.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "mesh/between_plates.h"
#include "solid/elastic_assembly.h"
#include "solid/surface_compliance.h"

namespace hapsim {
namespace {

// Beyond this many patch nodes the dense part costs more than factorisations of their own.
constexpr std::size_t kMostShared = 2000;

std::vector<char> not_bonded(const TetMesh& mesh) {
  std::vector<char> free;
  for (const std::uint8_t fixed : mesh.fixed) free.push_back(fixed ? 0 : 1);
  return free;
}

}  // namespace

MeshPatch patch_under_tool(const TetMesh& mesh, const Vec3& point, double radius) {
  const Surface surface = boundary_surface(mesh);
  const SurfacePoint at = nearest_point(surface, point);
  if (at.distance > std::max(3 * radius, 0.01))
    fail_input(fmt::format("contact at ({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z()),
               fmt::format("it lies {:.3g} m off the body's surface", at.distance),
               "check the frame and the unit");
  MeshPatch patch{{}, at.point, face_normal(surface, at.face).normalized()};
  // Between plates the face under the tool moves, not the sides.
  const double between = height_between_plates(surface, at.point, patch.normal, radius);
  const double reach = between > 0 ? 0.02 * between : 0.5 * radius;
  const double rim = between > 0 ? 1.02 : 1 + 1e-9;
  int nearest = -1;
  for (const int n : surface_nodes(mesh)) {
    if (mesh.fixed[n]) continue;
    const Vec3 away = mesh.nodes[n] - at.point;
    if (nearest < 0 || away.norm() < (mesh.nodes[nearest] - at.point).norm()) nearest = n;
    const double height = away.dot(patch.normal);
    if (std::abs(height) <= reach && (away - height * patch.normal).norm() <= radius * rim)
      patch.nodes.push_back(n);
  }
  if (nearest < 0)
    fail_input("", "every surface node of the body is bonded", "fix its support only");
  if (patch.nodes.empty()) patch.nodes.push_back(nearest);
  return patch;
}

MeshPress::MeshPress(const TetMesh& mesh, std::vector<MeshPatch> patches, SolverKind solver)
    : mesh_(mesh),
      patches_(std::move(patches)),
      dilatation_(mesh.order == 2 ? Dilatation::kElement : Dilatation::kPointwise) {
  assert(!patches_.empty());
  if (patches_.size() > 1) {
    shared_ = std::make_unique<NodeSystem>(not_bonded(mesh), element_cliques(mesh));
    choice_ = choose_solver(solver, shared_->unknowns(), shared_->matrix().row.size(),
                            4 * static_cast<int>(patches_.size()), mesh.order);
    std::size_t nodes = 0;
    for (const MeshPatch& p : patches_) nodes += p.nodes.size();
    if (nodes <= kMostShared && choice_.kind == SolverKind::kDirect) {
      std::vector<char> under(mesh.nodes.size(), 0), kept;
      for (const MeshPatch& p : patches_)
        for (const int n : p.nodes) under[n] = 1;
      for (std::size_t n = 0; n < under.size(); ++n)
        if (shared_->is_free(static_cast<int>(n))) kept.push_back(under[n]);
      condensed_ = std::make_unique<SchurInverse>(shared_->matrix(), kept);
      return;
    }
    shared_.reset();
    solver = choice_.kind;
  }
  for (const MeshPatch& patch : patches_) {
    std::vector<int> handle(mesh.nodes.size(), kFreeNode);
    for (std::size_t n = 0; n < handle.size(); ++n)
      if (mesh.fixed[n]) handle[n] = kHeldNode;
    for (const int n : patch.nodes) handle[n] = 0;
    apart_.push_back(std::make_unique<ElasticBody>(mesh, handle, dilatation_, solver));
  }
  if (patches_.size() == 1) choice_ = apart_[0]->solver();
}

std::vector<MeshPress::Solution> MeshPress::solve(const std::vector<Lame>& lame_of_tet) {
  if (shared_) return solve_together(lame_of_tet);
  std::vector<Solution> solutions;
  for (const auto& body : apart_) {
    body->factorise(lame_of_tet);
    ElasticBody::Response r = body->solve(Eigen::Matrix3d::Identity());
    const Eigen::Matrix3d K = r.reaction;
    solutions.push_back({0.5 * (K + K.transpose()), std::move(r.field)});
  }
  return solutions;
}

int MeshPress::iterations() const {
  int most = 0;
  for (const auto& body : apart_) most = std::max(most, body->iterations());
  return most;
}

std::vector<MeshPress::Solution> MeshPress::solve_together(const std::vector<Lame>& lame_of_tet) {
  assemble_elastic(*shared_, mesh_, lame_of_tet, dilatation_);
  Eigen::MatrixXd compliance;
  if (!condensed_->invert(shared_->matrix(), compliance))
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
  // Of a node: its block of the matrix, and its place among those under a tool; -1: none.
  std::vector<int> block(mesh_.nodes.size(), -1), place(mesh_.nodes.size(), -1);
  for (const MeshPatch& p : patches_)
    for (const int n : p.nodes) place[n] = 0;
  int blocks = 0, places = 0;
  for (std::size_t n = 0; n < block.size(); ++n) {
    if (shared_->is_free(static_cast<int>(n))) block[n] = blocks++;
    if (place[n] == 0) place[n] = places++;
  }
  std::vector<Solution> solutions;
  Eigen::MatrixXd load =
      Eigen::MatrixXd::Zero(shared_->unknowns(), 3 * static_cast<Eigen::Index>(patches_.size()));
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const std::vector<int>& nodes = patches_[p].nodes;
    const auto m = static_cast<Eigen::Index>(nodes.size());
    Eigen::MatrixXd c(3 * m, 3 * m);
    for (Eigen::Index a = 0; a < m; ++a)
      for (Eigen::Index b = 0; b < m; ++b)
        c.block<3, 3>(3 * a, 3 * b) =
            compliance.block<3, 3>(3 * place[nodes[a]], 3 * place[nodes[b]]);
    const Eigen::MatrixXd together = Eigen::Matrix3d::Identity().replicate(m, 1);
    const Eigen::MatrixXd forces = c.llt().solve(together);
    const Eigen::Matrix3d K = together.transpose() * forces;
    for (Eigen::Index a = 0; a < m; ++a)
      load.block<3, 3>(3 * block[nodes[a]], 3 * static_cast<Eigen::Index>(p)) =
          forces.middleRows<3>(3 * a);
    solutions.push_back({0.5 * (K + K.transpose()), {}});
  }
  const Eigen::MatrixXd x = condensed_->solve(load);
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    Eigen::MatrixXd& field = solutions[p].field;
    field = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh_.nodes.size()), 3);
    for (std::size_t n = 0; n < block.size(); ++n)
      if (block[n] >= 0)
        field.middleRows<3>(3 * static_cast<Eigen::Index>(n)) =
            x.block<3, 3>(3 * block[n], 3 * static_cast<Eigen::Index>(p));
  }
  return solutions;
}

}  // namespace hapsim
