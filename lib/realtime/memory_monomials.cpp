#include "realtime/memory_monomials.h"

#include "realtime/power_table.h"

namespace hapsim {
namespace {

constexpr int kMemoryAcross = 4;
constexpr std::array<int, kMemoryAcross + 1> kMemoryDeep{6, 4, 4, 2, 1};

struct MemoryPowers {
  int i, j, k;
};

// Calls f(m, i) of each run, in their order.
template <class F>
constexpr void each_memory_run(F f) {
  for (int linear = 1; linear >= 0; --linear)
    for (int m = 0; m <= kMemoryAcross; ++m)
      for (int i = 0; i <= kMemoryDeep[static_cast<std::size_t>(m)]; ++i)
        if (i + m > 0 && (i + m == 1) == (linear == 1)) f(m, i);
}

constexpr std::array<MemoryPowers, kMemoryTerms> memory_powers() {
  std::array<MemoryPowers, kMemoryTerms> powers{};
  std::size_t n = 0;
  each_memory_run([&](int m, int i) {
    for (int j = m; j >= 0; --j) powers[n++] = {i, j, m - j};
  });
  return powers;
}
constexpr std::array<MemoryPowers, kMemoryTerms> kMemoryPowers = memory_powers();

}  // namespace

MemorySet memory_set(int least, int most, int across) {
  MemorySet set;
  const auto add = [&](int own, int first) {
    set.run[static_cast<std::size_t>(set.runs++)] = {set.size, own};
    for (int b = 0; b <= own; ++b)
      set.at[static_cast<std::size_t>(set.size++)] = first < 0 ? -1 : first + b;
  };
  if (least == 0) add(0, -1);
  int n = 0;
  each_memory_run([&](int m, int i) {
    if (i + m >= least && i + m <= most && m <= across) add(m, n);
    n += m + 1;
  });
  return set;
}

MemoryPoint memory_point(const Vec3& v, const Vec3& rest) noexcept {
  const PowerTable d(v[0]), p(v[1]), q(v[2]);
  const bool along = !rest.isZero(0);
  MemoryPoint at;
  for (int t = 0; t < kMemoryTerms; ++t) {
    const auto [i, j, k] = kMemoryPowers[static_cast<std::size_t>(t)];
    at.m[t] = d.f[i] * p.f[j] * q.f[k];
    Vec3 g(d.d[i] * p.f[j] * q.f[k], d.f[i] * p.d[j] * q.f[k], d.f[i] * p.f[j] * q.d[k]);
    if (along) {
      at.m[t] += g.dot(rest);
      const double dp = d.d[i] * p.d[j] * q.f[k], dq = d.d[i] * p.f[j] * q.d[k],
                   pq = d.f[i] * p.d[j] * q.d[k];
      g += Vec3(d.dd[i] * p.f[j] * q.f[k] * rest[0] + dp * rest[1] + dq * rest[2],
                dp * rest[0] + d.f[i] * p.dd[j] * q.f[k] * rest[1] + pq * rest[2],
                dq * rest[0] + pq * rest[1] + d.f[i] * p.f[j] * q.dd[k] * rest[2]);
    }
    at.gradient.col(t) = g;
  }
  return at;
}

MemoryTurn::MemoryTurn(const Eigen::Matrix3d& R) noexcept {
  static_assert(kAcross == kMemoryAcross);
  for (int m = 0; m <= kAcross; ++m) {
    auto& T = by_[static_cast<std::size_t>(m)];
    T.setZero();
    for (int a = 0; a <= m; ++a) {
      std::array<double, kAcross + 2> c{1};  // by the power of q
      for (int k = 0; k < m; ++k) {
        const int row = k < m - a ? 1 : 2;
        for (int b = k + 1; b >= 0; --b)
          c[static_cast<std::size_t>(b)] =
              R(row, 1) * c[static_cast<std::size_t>(b)] +
              (b > 0 ? R(row, 2) * c[static_cast<std::size_t>(b - 1)] : 0);
      }
      for (int b = 0; b <= m; ++b) T(a, b) = c[static_cast<std::size_t>(b)];
    }
  }
}

void MemoryTurn::turn(const MemorySet& set, const double* from, double* to, int inner,
                      int outer) const noexcept {
  for (int o = 0; o < outer; ++o, from += inner * set.size, to += inner * set.size)
    for (int r = 0; r < set.runs; ++r) {
      const auto [first, across] = set.run[static_cast<std::size_t>(r)];
      const auto& T = by_[static_cast<std::size_t>(across)];
      for (int b = 0; b <= across; ++b) {
        double* sum = to + (first + b) * inner;
        const double* one = from + first * inner;
        for (int k = 0; k < inner; ++k) sum[k] = T(0, b) * one[k];
        for (int a = 1; a <= across; ++a) {
          one += inner;
          for (int k = 0; k < inner; ++k) sum[k] += T(a, b) * one[k];
        }
      }
    }
}

}  // namespace hapsim
