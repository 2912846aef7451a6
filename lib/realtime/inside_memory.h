// What the inside of a relaxing body does otherwise than the static one's.
#pragma once

#include "realtime/memory_monomials.h"

namespace hapsim {

// The inside of a body that remembers stresses of other states departs from where the static body
// has it, which the force feels at second order; where the tool leaves and the force passes through
// zero that is all there is. It departs along nine fields y_j alone, nearly: what the stresses
// S(v) = s_b v_b + s_bc v_b v_c, by least squares, move inside a body that is pressed a little,
// straight down, y = -K^-1 (their forces), one a monomial. By amplitudes x of these
// (Galerkin's method) the strains at displacement u are
//   E(u, x) = E(u) + sum of x_j E_j(u) + x_j x_k E_jk / 2,   E_j = dE/dy_j,
// the stresses S(u) + sum of x_j D E_j, D the law's moduli, both with what of them fades. x holds
// the inside in equilibrium,
//   [A (1 + c) + G(m) + G(h)]_jk x_k = -h_m g_jnm n_n(u) - A_jk z_k0,
// with h the memories of m as in StrainMemory, and where all is over k a^2
//   g_jnm n_n m_m = integral of S(v) : E_j(u), by monomials n of u and m of v,
//   w_jnm n_n m_m = integral of D E_j(v) : E(u), by n of v and m of u,
//   A_jkn n_n     = integral of E_j : D E_k at u,
//   G_jkm m_m     = integral of S(v) : E_jk,
//   z_jn          memories of x_j n(u), z_k0 of x_k alone; c the share that a step adds at once.
// Forces over k a in axes of v:
//   f = x_j h_m g_jnm n'_n + x_j (A' + G(m)')_jk x_k / 2 + z_jn w_jnm m'_m + x_j A'_jk z_k0 / 2.
// Nothing where what is remembered is a multiple of what is now. Fields of the undeformed body hold
// 13 to 27 % of the energy of what the inside of a block does where the force passes through zero
// on the way out, these 42 to 58 %; fields of deeper states hold more there and less of what comes
// after, and forces are worse. Springs under a body are left out of A, as if the fields did not
// reach them.
constexpr int kInsideFields = 9, kInsideNow = 22, kInsideBefore = 21;
using InsideAmplitudes = Eigen::Matrix<double, kInsideFields, kInsideNow>;  // x_j n(u)

struct InsideMemory {
  Eigen::Matrix<double, kInsideFields * kInsideNow, kInsideBefore> g, w;         // rows: j + 9 n
  Eigen::Matrix<double, kInsideFields * kInsideFields, kInsideNow> stiffness;    // A; rows: j + 9 k
  Eigen::Matrix<double, kInsideFields * kInsideFields, kInsideBefore> stressed;  // G
  InsideMemory() { set_zero(); }
  void set_zero() noexcept;
  void scale(double by) noexcept;
};
const MemorySet& inside_ways();    // monomials that j counts
const MemorySet& inside_now();     // n
const MemorySet& inside_before();  // m

// Allocates and throws nothing.
void add_turned(const InsideMemory& of, const MemoryTurn& turn, double weight,
                InsideMemory& sum) noexcept;

struct InsideForce {
  Vec3 f = Vec3::Zero();
  InsideAmplitudes x = InsideAmplitudes::Zero();  // now
  bool held = true;  // false: no equilibrium along these fields, and f is zero
};
// `h`: sum over Maxwell elements of share times memory; `faded` of share times (a z - c x before),
// `at_once` of share times c (MemoryStep). Allocates and throws nothing.
InsideForce inside_force(const InsideMemory& inside, const MemoryPoint& at, const MemoryVector& h,
                         const InsideAmplitudes& faded, double at_once) noexcept;

}  // namespace hapsim
