// The coarse grid of a mesh whose edges have nodes in their middles: private to lib/linalg.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "linalg/conjugate_gradients.h"
#include "linalg/sparse_cholesky.h"

namespace hapsim {

// Elements of second order restricted to functions that are linear in them (Galerkin's P' A P, P
// the interpolation between the ends of each edge), in blocks of three unknowns: an eighth of the
// unknowns, and what is smooth over many elements, which an incomplete factor hardly moves.
class MidpointGrid {
 public:
  // Takes what it needs of the fine matrix; `block_order`: of the fine blocks, in which
  // add_correction() takes its vectors.
  void assemble(const SymmetricSparse& matrix, const BlockEnds& ends,
                const std::vector<int>& block_order);
  // Its incomplete factor. False when the coarse diagonal is not positive.
  bool factorise();
  // z += S P (P' A P)^-1 P' S r, the inverse to a tenth of the load, which differs from call to
  // call; S = diag(1 / scale); kLanes columns side by side.
  void add_correction(const Eigen::VectorXd& scale, const std::vector<double>& r,
                      std::vector<double>& z) const;
  std::size_t held_bytes() const {
    return hapsim::held_bytes(ends_) + hapsim::held_bytes(matrix_) + solver_.held_bytes();
  }

 private:
  // Calls visit(coarse block, weight) for those that the fine block interpolates.
  template <class Visit>
  static void each_end(const std::array<int, 2>& ends, const Visit& visit);

  std::vector<std::array<int, 2>> ends_;  // coarse blocks of each fine block, in the fine order
  int blocks_ = 0;
  SymmetricSparse matrix_;  // until factorise()
  ConjugateGradients solver_;
};

}  // namespace hapsim
