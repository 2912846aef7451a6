// Monomials of the ways of a tool, of which a relaxing body's memory is a polynomial, and how these
// turn with the axes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "base/vec3.h"

namespace hapsim {

// Monomials of the ways v = (d, p, q) over the tool's radius: d, p, q first, then all others of
// degree 2 and more that d^i p^j q^k has with i to 6 where j + k = 0, to 4, 4, 2 and 1 where it is
// 1 to 4.
constexpr int kMemoryTerms = 53;
using MemoryVector = Eigen::Matrix<double, kMemoryTerms, 1>;

// Their values and gradients at v, or along the tangent from there at v + rest. Allocates and
// throws nothing.
struct MemoryPoint {
  MemoryVector m;
  Eigen::Matrix<double, 3, kMemoryTerms> gradient;
};
MemoryPoint memory_point(const Vec3& v, const Vec3& rest = Vec3::Zero()) noexcept;

// Some of them, in their order: those of degrees `least` to `most` and of j + k to `across`, the
// constant first where `least` is 0. What turns about d mix are runs of them, of the same i and j +
// k.
struct MemorySet {
  struct Run {
    int first, across;  // its place in the set, j + k: across + 1 monomials
  };
  int size = 0, runs = 0;
  std::array<int, kMemoryTerms + 1> at{};  // places among all; -1: the constant
  std::array<Run, 22> run{};
};
MemorySet memory_set(int least, int most, int across = 4);

// Values and gradients of a set.
template <int N>
struct MemoryPart {
  MemoryPart(const MemorySet& set, const MemoryPoint& of) noexcept {
    for (int t = 0; t < N; ++t) {
      const int all = set.at[static_cast<std::size_t>(t)];
      m[t] = all < 0 ? 1 : of.m[all];
      if (all < 0)
        gradient.col(t).setZero();
      else
        gradient.col(t) = of.gradient.col(all);
    }
  }
  Eigen::Matrix<double, N, 1> m;
  Eigen::Matrix<double, 3, N> gradient;
};

// Coefficients c of monomials, sum of c_t m_t(R v) = sum of (turned c)_t m_t(v), R one along d and
// orthogonal across it. Allocates and throws nothing.
class MemoryTurn {
 public:
  explicit MemoryTurn(const Eigen::Matrix3d& R) noexcept;
  // Of an array of coefficients of the set's monomials, `inner` numbers each, `outer` times one
  // after the other; to another place.
  void turn(const MemorySet& set, const double* from, double* to, int inner,
            int outer) const noexcept;

 private:
  static constexpr int kAcross = 4;
  // (a, b): what p^b' q^(m-b') has in the turned p^a' q^(m-a'), a' = m - a; by m.
  std::array<Eigen::Matrix<double, kAcross + 1, kAcross + 1>, kAcross + 1> by_;
};

}  // namespace hapsim
