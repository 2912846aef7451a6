// Symmetric matrices of small dense blocks, and the passes over them that conjugate gradients are
// made of: private to lib/linalg.
#pragma once

#include <vector>

#include "linalg/cuthill_mckee.h"
#include "linalg/sparse_cholesky.h"

namespace hapsim {

// The lower triangle by columns of blocks, B x B numbers each, row after row; the diagonal block
// stands first in its column and holds both of its triangles.
template <int B, class Number>
struct BlockSparse {
  LowerPattern pattern;
  std::vector<Number> value;
  std::size_t held_bytes() const {
    return hapsim::held_bytes(pattern.start) + hapsim::held_bytes(pattern.row) +
           hapsim::held_bytes(value);
  }
};

// The matrix with its blocks in the given order.
template <int B>
BlockSparse<B, double> reordered_blocks(const SymmetricSparse& matrix,
                                        const std::vector<int>& order);
LowerPattern block_pattern(const SymmetricSparse& matrix, int block);

// L L' = A + shift 1 on the pattern of A, by blocks; a diagonal block of L is stored inverted.
// False when a pivot falls below 1/1000 of a unit diagonal's.
template <int B>
bool incomplete_cholesky(const BlockSparse<B, double>& a, double shift, BlockSparse<B, float>& l);

// Vectors hold four columns side by side: x[4 * unknown + column].
constexpr int kLanes = 4;
// y = A x.
void multiply(const BlockSparse<1, double>& a, const double* x, double* y);
void multiply(const BlockSparse<3, double>& a, const double* x, double* y);
// z = (L L')^-1 z.
void apply_inverse(const BlockSparse<1, float>& l, double* z);
void apply_inverse(const BlockSparse<3, float>& l, double* z);

}  // namespace hapsim
