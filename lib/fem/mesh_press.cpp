#include "fem/mesh_press.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/error.h"
#include "fem/elastic_assembly.h"
#include "fem/surface_compliance.h"

namespace hapsim {
namespace {

// Beyond this many patch nodes a position is cheaper on a factorisation of its own.
constexpr std::size_t kMostShared = 64;

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
  int nearest = -1;
  for (const int n : surface_nodes(mesh)) {
    if (mesh.fixed[n]) continue;
    const Vec3 away = mesh.nodes[n] - at.point;
    if (nearest < 0 || away.norm() < (mesh.nodes[nearest] - at.point).norm()) nearest = n;
    const double height = away.dot(patch.normal);
    if (std::abs(height) <= 0.5 * radius &&
        (away - height * patch.normal).norm() <= radius * (1 + 1e-9))
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
  const bool small = std::all_of(patches_.begin(), patches_.end(),
                                 [](const MeshPatch& p) { return p.nodes.size() <= kMostShared; });
  if (patches_.size() > 1) {
    shared_ = std::make_unique<NodeSystem>(not_bonded(mesh), element_cliques(mesh));
    choice_ = choose_solver(solver, shared_->unknowns(), shared_->matrix().row.size(),
                            4 * static_cast<int>(patches_.size()));
    if (small && choice_.kind == SolverKind::kDirect) return;
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

std::vector<MeshPress::Solution> MeshPress::solve_together(const std::vector<Lame>& lame_of_tet) {
  assemble_elastic(*shared_, mesh_, lame_of_tet, dilatation_);
  if (!shared_->factorise())
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
  std::vector<Solution> solutions;
  // Some hundred columns at a time: enough for the solver to be busy, few enough for the memory.
  for (std::size_t first = 0, last = 0; first < patches_.size(); first = last) {
    Eigen::Index columns = 0;
    for (last = first; last < patches_.size() && (last == first || columns < 192); ++last)
      columns += 3 * static_cast<Eigen::Index>(patches_[last].nodes.size());
    Eigen::MatrixXd load =
        Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh_.nodes.size()), columns);
    Eigen::Index column = 0;
    for (std::size_t p = first; p < last; ++p)
      for (const int n : patches_[p].nodes)
        for (int k = 0; k < 3; ++k) load(3 * n + k, column++) = 1;
    const Eigen::MatrixXd x = shared_->solve(load);
    column = 0;
    for (std::size_t p = first; p < last; ++p) {
      const std::vector<int>& nodes = patches_[p].nodes;
      const auto m = 3 * static_cast<Eigen::Index>(nodes.size());
      Eigen::MatrixXd c(m, m), together(m, 3);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const auto row = 3 * static_cast<Eigen::Index>(a);
        c.middleRows(row, 3) = x.block(3 * nodes[a], column, 3, m);
        together.middleRows(row, 3).setIdentity();
      }
      const Eigen::MatrixXd forces = c.llt().solve(together);
      const Eigen::Matrix3d K = together.transpose() * forces;
      solutions.push_back({0.5 * (K + K.transpose()), x.middleCols(column, m) * forces});
      column += m;
    }
  }
  return solutions;
}

}  // namespace hapsim
