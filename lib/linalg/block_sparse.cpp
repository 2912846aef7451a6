#include "linalg/block_sparse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

// The same source for processors with and without fused multiplication of four numbers at once;
// chosen when the program starts. The thread sanitizer is not yet there then, and would be called.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define HAPSIM_WIDE __attribute__((target_clones("fma", "default")))
#else
#define HAPSIM_WIDE
#endif
#define HAPSIM_INLINE inline __attribute__((always_inline))

namespace hapsim {
namespace {

// Four columns of one unknown; the compiler takes what registers the processor has.
typedef double Lane __attribute__((vector_size(8 * kLanes), aligned(8), may_alias));

template <int B>
struct Row {  // the unknowns of one block
  Lane at[B];
};

template <int B>
HAPSIM_INLINE Row<B> load(const double* x) {
  Row<B> row;
  for (int i = 0; i < B; ++i) row.at[i] = *reinterpret_cast<const Lane*>(x + kLanes * i);
  return row;
}
template <int B>
HAPSIM_INLINE void store(const Row<B>& row, double* x) {
  for (int i = 0; i < B; ++i) *reinterpret_cast<Lane*>(x + kLanes * i) = row.at[i];
}

// y += M x, or minus, or with M'.
template <int B, bool kTransposed, bool kMinus, class Number>
HAPSIM_INLINE void add_product(const Number* m, const Row<B>& x, Row<B>& y) {
  for (int j = 0; j < B; ++j)
    for (int i = 0; i < B; ++i) {
      const double a = static_cast<double>(kTransposed ? m[B * j + i] : m[B * i + j]);
      if (kMinus)
        y.at[i] -= a * x.at[j];
      else
        y.at[i] += a * x.at[j];
    }
}

template <int B>
HAPSIM_INLINE void multiply_blocks(const BlockSparse<B, double>& a, const double* x, double* y) {
  constexpr int kStep = kLanes * B;
  const int* start = a.pattern.start.data();
  const int* row = a.pattern.row.data();
  const int size = a.pattern.size();
  std::fill(y, y + static_cast<std::ptrdiff_t>(kStep) * size, 0.0);
  for (int c = 0; c < size; ++c) {
    const Row<B> xc = load<B>(x + static_cast<std::ptrdiff_t>(kStep) * c);
    double* yc = y + static_cast<std::ptrdiff_t>(kStep) * c;
    Row<B> sum = load<B>(yc);
    const double* m = a.value.data() + static_cast<std::ptrdiff_t>(B * B) * start[c];
    add_product<B, false, false>(m, xc, sum);
    for (int k = start[c] + 1; k < start[c + 1]; ++k) {
      m += B * B;
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(kStep) * row[k];
      Row<B> there = load<B>(y + at);
      add_product<B, false, false>(m, xc, there);
      store(there, y + at);
      add_product<B, true, false>(m, load<B>(x + at), sum);
    }
    store(sum, yc);
  }
}

template <int B>
HAPSIM_INLINE void apply_inverse_blocks(const BlockSparse<B, float>& l, double* z) {
  constexpr int kStep = kLanes * B;
  const int* start = l.pattern.start.data();
  const int* row = l.pattern.row.data();
  const float* value = l.value.data();
  for (int c = 0; c < l.pattern.size(); ++c) {
    double* zc = z + static_cast<std::ptrdiff_t>(kStep) * c;
    Row<B> solved{};
    const float* m = value + static_cast<std::ptrdiff_t>(B * B) * start[c];
    add_product<B, false, false>(m, load<B>(zc), solved);
    store(solved, zc);
    for (int k = start[c] + 1; k < start[c + 1]; ++k) {
      m += B * B;
      double* zr = z + static_cast<std::ptrdiff_t>(kStep) * row[k];
      Row<B> there = load<B>(zr);
      add_product<B, false, true>(m, solved, there);
      store(there, zr);
    }
  }
  for (int c = l.pattern.size() - 1; c >= 0; --c) {
    double* zc = z + static_cast<std::ptrdiff_t>(kStep) * c;
    Row<B> sum = load<B>(zc), solved{};
    const float* diagonal = value + static_cast<std::ptrdiff_t>(B * B) * start[c];
    const float* m = diagonal;
    for (int k = start[c] + 1; k < start[c + 1]; ++k) {
      m += B * B;
      add_product<B, true, true>(m, load<B>(z + static_cast<std::ptrdiff_t>(kStep) * row[k]), sum);
    }
    add_product<B, true, false>(diagonal, sum, solved);
    store(solved, zc);
  }
}

// In place: the inverse of the lower Cholesky factor, row after row, zeros above.
template <int B>
bool invert_pivot(float* a) {
  constexpr double kLeast = 1e-3;
  double l[B * B] = {};
  for (int j = 0; j < B; ++j)
    for (int i = j; i < B; ++i) {
      double sum = a[B * i + j];
      for (int k = 0; k < j; ++k) sum -= l[B * i + k] * l[B * j + k];
      if (i > j) {
        l[B * i + j] = sum / l[B * j + j];
        continue;
      }
      // A pivot far below one makes a factor worse than none.
      if (!(sum > kLeast)) return false;
      l[B * j + j] = std::sqrt(sum);
    }
  std::fill(a, a + B * B, 0.0F);
  for (int j = 0; j < B; ++j)
    for (int i = j; i < B; ++i) {
      double sum = i == j ? 1 : 0;
      for (int k = j; k < i; ++k) sum -= l[B * i + k] * a[B * k + j];
      a[B * i + j] = static_cast<float>(sum / l[B * i + i]);
    }
  return true;
}

// c -= a b', or c = a b' when it is to be replaced.
template <int B>
void subtract_product(const float* a, const float* b, float* c) {
  for (int i = 0; i < B; ++i)
    for (int j = 0; j < B; ++j) {
      float sum = 0;
      for (int k = 0; k < B; ++k) sum += a[B * i + k] * b[B * j + k];
      c[B * i + j] -= sum;
    }
}

}  // namespace

LowerPattern block_pattern(const SymmetricSparse& matrix, int block) {
  LowerPattern pattern;
  pattern.start.push_back(0);
  for (int b = 0; b < matrix.size / block; ++b) {
    int last = -1;
    for (int k = matrix.column_start[b * block]; k < matrix.column_start[b * block + 1]; ++k)
      if (matrix.row[k] / block != last) pattern.row.push_back(last = matrix.row[k] / block);
    pattern.start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

template <int B>
BlockSparse<B, double> reordered_blocks(const SymmetricSparse& matrix,
                                        const std::vector<int>& order) {
  const LowerPattern from = block_pattern(matrix, B);
  const int size = from.size();
  std::vector<int> place(order.size());
  for (int k = 0; k < size; ++k) place[order[k]] = k;
  BlockSparse<B, double> result;
  std::vector<int>& start = result.pattern.start;
  start.assign(static_cast<std::size_t>(size) + 1, 0);
  for (int c = 0; c < size; ++c)
    for (int k = from.start[c]; k < from.start[c + 1]; ++k)
      ++start[std::min(place[c], place[from.row[k]]) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  // (row, where it was), by new column.
  std::vector<std::array<int, 3>> moved(from.row.size());
  std::vector<int> next(start.begin(), start.end() - 1);
  for (int c = 0; c < size; ++c)
    for (int k = from.start[c]; k < from.start[c + 1]; ++k) {
      const auto [low, high] = std::minmax(place[c], place[from.row[k]]);
      moved[next[low]++] = {high, c, k - from.start[c]};
    }
  result.pattern.row.reserve(from.row.size());
  result.value.assign(from.row.size() * B * B, 0.0);
  double* out = result.value.data();
  for (int c = 0; c < size; ++c) {
    std::sort(moved.begin() + start[c], moved.begin() + start[c + 1]);
    for (int k = start[c]; k < start[c + 1]; ++k) {
      const auto& [row, old_column, at] = moved[k];
      result.pattern.row.push_back(row);
      // Whether the block is the other way round in the new order.
      const bool turned = place[old_column] != c;
      for (int j = 0; j < B; ++j) {
        // The first block of a column is the diagonal's lower triangle, B - j high.
        const double* value = matrix.value.data() + matrix.column_start[B * old_column + j] +
                              (at == 0 ? 0 : B * at - j);
        for (int i = at == 0 ? j : 0; i < B; ++i, ++value) {
          if (turned || at == 0) out[B * j + i] = *value;
          if (!turned || at == 0) out[B * i + j] = *value;
        }
      }
      out += B * B;
    }
  }
  return result;
}

template <int B>
bool incomplete_cholesky(const BlockSparse<B, double>& a, double shift, BlockSparse<B, float>& l) {
  const std::vector<int>& start = a.pattern.start;
  const std::vector<int>& row = a.pattern.row;
  l.value.assign(a.value.begin(), a.value.end());
  const auto block = [&](int k) { return l.value.data() + static_cast<std::ptrdiff_t>(B * B) * k; };
  const int size = a.pattern.size();
  for (int c = 0; c < size; ++c) {
    const int begin = start[c], end = start[c + 1];
    float* pivot = block(begin);
    for (int i = 0; i < B; ++i) pivot[B * i + i] += static_cast<float>(shift);
    if (!invert_pivot<B>(pivot)) return false;
    for (int k = begin + 1; k < end; ++k) {
      float scaled[B * B] = {};  // A_rc L_cc^-T
      subtract_product<B>(block(k), pivot, scaled);
      for (int i = 0; i < B * B; ++i) block(k)[i] = -scaled[i];
    }
    // Column c times its own blocks, where the target column has a place for it.
    for (int k = begin + 1; k < end; ++k) {
      int target = start[row[k]];
      const int target_end = start[row[k] + 1];
      for (int i = k; i < end; ++i) {
        while (target < target_end && row[target] < row[i]) ++target;
        if (target == target_end) break;
        if (row[target] == row[i]) subtract_product<B>(block(i), block(k), block(target));
      }
    }
  }
  l.pattern = a.pattern;
  return true;
}

template BlockSparse<1, double> reordered_blocks<1>(const SymmetricSparse&,
                                                    const std::vector<int>&);
template BlockSparse<3, double> reordered_blocks<3>(const SymmetricSparse&,
                                                    const std::vector<int>&);
template bool incomplete_cholesky<1>(const BlockSparse<1, double>&, double, BlockSparse<1, float>&);
template bool incomplete_cholesky<3>(const BlockSparse<3, double>&, double, BlockSparse<3, float>&);

HAPSIM_WIDE void multiply(const BlockSparse<1, double>& a, const double* x, double* y) {
  multiply_blocks<1>(a, x, y);
}
HAPSIM_WIDE void multiply(const BlockSparse<3, double>& a, const double* x, double* y) {
  multiply_blocks<3>(a, x, y);
}
HAPSIM_WIDE void apply_inverse(const BlockSparse<1, float>& l, double* z) {
  apply_inverse_blocks<1>(l, z);
}
HAPSIM_WIDE void apply_inverse(const BlockSparse<3, float>& l, double* z) {
  apply_inverse_blocks<3>(l, z);
}

}  // namespace hapsim
