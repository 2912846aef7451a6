#include "solid/elastic_body.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "base/error.h"
#include "solid/elastic_assembly.h"

namespace hapsim {
namespace {

// What no element uses has no stiffness: it is held.
std::vector<int> used_handles(const TetMesh& mesh, std::vector<int> handle) {
  assert(handle.size() == mesh.nodes.size());
  const std::ptrdiff_t count = mesh.order == 1 ? 4 : 10;
  std::vector<char> used(handle.size(), 0);
  for (const auto& tet : mesh.tets)
    std::for_each(tet.begin(), tet.begin() + count, [&](int n) { used[n] = 1; });
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (!used[n]) handle[n] = kHeldNode;
  return handle;
}

std::vector<char> free_nodes(const std::vector<int>& handle) {
  std::vector<char> free;
  for (const int h : handle) free.push_back(h == kFreeNode ? 1 : 0);
  return free;
}

// Of each node the two that it lies between on an edge, itself twice when it is a corner.
std::vector<std::array<int, 2>> edge_ends(const TetMesh& mesh) {
  std::vector<std::array<int, 2>> ends(mesh.nodes.size());
  for (std::size_t n = 0; n < ends.size(); ++n)
    ends[n] = {static_cast<int>(n), static_cast<int>(n)};
  for (const auto& tet : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e)
      ends[tet[4 + e]] = {tet[kTetEdges[e][0]], tet[kTetEdges[e][1]]};
  return ends;
}

}  // namespace

ElasticBody::ElasticBody(const TetMesh& mesh, const std::vector<int>& handle, Dilatation dilatation,
                         SolverKind solver)
    : mesh_(mesh),
      handle_(used_handles(mesh, handle)),
      dilatation_(dilatation),
      system_(free_nodes(handle_), element_cliques(mesh)) {
  assert(dilatation != Dilatation::kPatch);
  for (const int h : handle_) handles_ = std::max(handles_, h + 1);
  choice_ = choose_solver(solver, system_.unknowns(), system_.matrix().row.size(), 3 * handles_,
                          mesh.order);
  system_.use(choice_.kind);
  if (mesh.order == 2) system_.lie_between(edge_ends(mesh));
}

void ElasticBody::factorise(const std::vector<Lame>& lame_of_tet) {
  lame_ = lame_of_tet;
  assemble_elastic(system_, mesh_, lame_, dilatation_);
  if (!system_.factorise())
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
}

std::size_t ElasticBody::held_bytes() const {
  using hapsim::held_bytes;
  return held_bytes(handle_) + held_bytes(system_) + held_bytes(choice_.why) + held_bytes(lame_);
}

bool ElasticBody::is_touched(std::size_t tet) const {
  const auto begin = mesh_.tets[tet].begin();
  return std::any_of(begin, begin + (mesh_.order == 1 ? 4 : 10),
                     [&](int n) { return handle_[n] >= 0; });
}

ElasticBody::Response ElasticBody::solve(const Eigen::MatrixXd& prescribed) const {
  assert(prescribed.rows() == 3 * handles_ && lame_.size() == mesh_.tets.size());
  const Eigen::Index m = prescribed.cols();
  const int nodes_per_tet = mesh_.order == 1 ? 4 : 10;
  Response response;
  Eigen::MatrixXd& field = response.field;
  field = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh_.nodes.size()), m);
  for (std::size_t n = 0; n < handle_.size(); ++n)
    if (handle_[n] >= 0) field.middleRows(3 * n, 3) = prescribed.middleRows(3 * handle_[n], 3);
  std::vector<std::size_t> touched;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
    if (is_touched(t)) touched.push_back(t);

  // Right-hand side: minus the forces that the moved handles cause on the free nodes.
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(field.rows(), m);
  for (const std::size_t t : touched) {
    const ElementStiffness element(mesh_, t, lame_[t], dilatation_);
    for (int a = 0; a < nodes_per_tet; ++a) {
      const int na = mesh_.tets[t][a];
      if (handle_[na] < 0) continue;
      for (int b = 0; b < nodes_per_tet; ++b)
        load.middleRows(3 * mesh_.tets[t][b], 3).noalias() -=
            element.block(b, a) * field.middleRows(3 * na, 3);
    }
  }
  field += system_.solve(load);

  response.reaction = Eigen::MatrixXd::Zero(3 * handles_, m);
  for (const std::size_t t : touched) {
    const ElementStiffness element(mesh_, t, lame_[t], dilatation_);
    for (int a = 0; a < nodes_per_tet; ++a) {
      const int h = handle_[mesh_.tets[t][a]];
      if (h < 0) continue;
      for (int b = 0; b < nodes_per_tet; ++b)
        response.reaction.middleRows(3 * h, 3).noalias() +=
            element.block(a, b) * field.middleRows(3 * mesh_.tets[t][b], 3);
    }
  }
  return response;
}

}  // namespace hapsim
