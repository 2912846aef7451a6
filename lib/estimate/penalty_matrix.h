// The penalty of a field on a graph as a sparse matrix: private to lib/estimate.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "estimate/regularised.h"
#include "linalg/sparse_cholesky.h"

namespace hapsim {

// Total variation |t| is sqrt(t^2 + kEdge^2): jumps well above it (2 % of a modulus whose logarithm
// is the field) are left sharp.
inline constexpr double kEdge = 0.02;

// R = sum of q_e (edge_weight D)_e^2 + node_weight^2 on a pattern that stays.
class PenaltyMatrix {
 public:
  explicit PenaltyMatrix(const FieldProblem& problem);  // which must outlive it
  // The edges' factors q (on the squared weights).
  void set(const Eigen::VectorXd& q);
  // R^-1 J', after set(q); empty where R is not positive definite.
  Eigen::MatrixXd inverse_times_J(const Eigen::VectorXd& q);
  struct Inverse {
    Eigen::VectorXd diagonal;  // of R^-1, for the last q
    Eigen::VectorXd beside;    // its entries at the ends of each edge
  };
  Inverse inverse() const;

 private:
  double& diagonal(Eigen::Index i) { return matrix_.value[matrix_.column_start[i]]; }
  const FieldProblem& problem_;
  SymmetricSparse matrix_;
  std::vector<std::ptrdiff_t> place_;
  std::unique_ptr<SparseCholesky> cholesky_;
};

// `of_jump`(t) of every edge's weighted jump.
template <class Function>
Eigen::VectorXd edge_factors(const FieldProblem& p, const Eigen::VectorXd& m,
                             const Function& of_jump) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(p.edges.size()));
  for (Eigen::Index e = 0; e < q.size(); ++e) {
    const auto& [a, b] = p.edges[static_cast<std::size_t>(e)];
    q[e] = of_jump(p.edge_weight[e] * (m[a] - m[b]));
  }
  return q;
}

}  // namespace hapsim
