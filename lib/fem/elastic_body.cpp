#include "fem/elastic_body.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"

namespace hapsim {
ElasticBody::ElasticBody(const TetMesh& mesh, const std::vector<int>& handle, Dilatation dilatation)
    : mesh_(mesh), handle_(handle), block_of_node_(mesh.nodes.size(), -1), dilatation_(dilatation) {
  assert(dilatation != Dilatation::kPatch);
  assert(handle.size() == mesh.nodes.size());
  const int nodes_per_tet = mesh.order == 1 ? 4 : 10;
  std::vector<char> used(mesh.nodes.size(), 0);
  for (const auto& tet : mesh.tets)
    for (int a = 0; a < nodes_per_tet; ++a) used[tet[a]] = 1;
  int blocks = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (!used[n]) handle_[n] = kHeldNode;
    if (handle_[n] == kFreeNode) block_of_node_[n] = blocks++;
    handles_ = std::max(handles_, handle_[n] + 1);
  }
  matrix_.size = 3 * blocks;
  build_pattern();
  if (blocks > 0) cholesky_ = std::make_unique<SparseCholesky>(matrix_, 3);
}

void ElasticBody::build_pattern() {
  const int blocks = matrix_.size / 3;
  const int nodes_per_tet = mesh_.order == 1 ? 4 : 10;
  std::vector<std::vector<int>> below(blocks);  // neighbours with a higher or the same number
  for (const auto& tet : mesh_.tets)
    for (int a = 0; a < nodes_per_tet; ++a)
      for (int b = 0; b < nodes_per_tet; ++b) {
        const int column = block_of_node_[tet[a]], row = block_of_node_[tet[b]];
        if (column >= 0 && row >= column) below[column].push_back(row);
      }
  matrix_.column_start.assign(1, 0);
  for (int c = 0; c < blocks; ++c) {
    auto& rows = below[c];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (int k = 0; k < 3; ++k) {
      for (const int r : rows)
        for (int l = (r == c ? k : 0); l < 3; ++l) matrix_.row.push_back(3 * r + l);
      matrix_.column_start.push_back(static_cast<int>(matrix_.row.size()));
    }
  }
  matrix_.value.assign(matrix_.row.size(), 0);
}

void ElasticBody::factorise(const std::vector<Lame>& lame_of_tet) {
  assert(lame_of_tet.size() == mesh_.tets.size());
  lame_ = lame_of_tet;
  if (!cholesky_) return;
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  const int nodes_per_tet = mesh_.order == 1 ? 4 : 10;
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    const ElementStiffness element(mesh_, t, lame_[t], dilatation_);
    for (int a = 0; a < nodes_per_tet; ++a) {
      const int column = block_of_node_[mesh_.tets[t][a]];
      if (column < 0) continue;
      for (int b = 0; b < nodes_per_tet; ++b) {
        const int row = block_of_node_[mesh_.tets[t][b]];
        if (row < column) continue;
        const Eigen::Matrix3d k = element.block(b, a);
        for (int j = 0; j < 3; ++j) {
          const int* begin = matrix_.row.data() + matrix_.column_start[3 * column + j];
          const int* end = matrix_.row.data() + matrix_.column_start[3 * column + j + 1];
          const int first = row == column ? j : 0;
          const int* at = std::lower_bound(begin, end, 3 * row + first);
          double* value = matrix_.value.data() + (at - matrix_.row.data());
          for (int i = first; i < 3; ++i) value[i - first] += k(i, j);
        }
      }
    }
  }
  if (!cholesky_->factorise(matrix_))
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
}

ElasticBody::Response ElasticBody::solve(const Eigen::MatrixXd& prescribed) const {
  assert(prescribed.rows() == 3 * handles_ && lame_.size() == mesh_.tets.size());
  const Eigen::Index m = prescribed.cols();
  const int nodes_per_tet = mesh_.order == 1 ? 4 : 10;
  Response response;
  response.field = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(mesh_.nodes.size()), m);
  std::vector<char> touched(mesh_.tets.size(), 0);
  for (std::size_t n = 0; n < handle_.size(); ++n)
    if (handle_[n] >= 0)
      response.field.middleRows(3 * n, 3) = prescribed.middleRows(3 * handle_[n], 3);
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
    for (int a = 0; a < nodes_per_tet; ++a) touched[t] |= handle_[mesh_.tets[t][a]] >= 0;

  // Right-hand side: minus the forces that the moved handles cause on the free nodes.
  if (cholesky_) {
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(matrix_.size, m);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (!touched[t]) continue;
      const ElementStiffness element(mesh_, t, lame_[t], dilatation_);
      for (int a = 0; a < nodes_per_tet; ++a) {
        const int na = mesh_.tets[t][a];
        if (handle_[na] < 0) continue;
        for (int b = 0; b < nodes_per_tet; ++b) {
          const int row = block_of_node_[mesh_.tets[t][b]];
          if (row < 0) continue;
          load.middleRows(3 * row, 3).noalias() -=
              element.block(b, a) * response.field.middleRows(3 * na, 3);
        }
      }
    }
    const Eigen::MatrixXd x = cholesky_->solve(load);
    for (std::size_t n = 0; n < handle_.size(); ++n)
      if (block_of_node_[n] >= 0)
        response.field.middleRows(3 * n, 3) = x.middleRows(3 * block_of_node_[n], 3);
  }

  response.reaction = Eigen::MatrixXd::Zero(3 * handles_, m);
  for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
    if (!touched[t]) continue;
    const ElementStiffness element(mesh_, t, lame_[t], dilatation_);
    for (int a = 0; a < nodes_per_tet; ++a) {
      const int h = handle_[mesh_.tets[t][a]];
      if (h < 0) continue;
      for (int b = 0; b < nodes_per_tet; ++b)
        response.reaction.middleRows(3 * h, 3).noalias() +=
            element.block(a, b) * response.field.middleRows(3 * mesh_.tets[t][b], 3);
    }
  }
  return response;
}

}  // namespace hapsim
