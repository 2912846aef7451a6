#include "realtime/inside_memory.h"

#include <Eigen/Cholesky>

namespace hapsim {

const MemorySet& inside_ways() {
  static const MemorySet set = memory_set(1, 2);
  return set;
}
const MemorySet& inside_now() {
  static const MemorySet set = memory_set(0, 4, 2);
  return set;
}
const MemorySet& inside_before() {
  static const MemorySet set = memory_set(1, 4, 2);
  return set;
}

void InsideMemory::set_zero() noexcept {
  g.setZero();
  w.setZero();
  stiffness.setZero();
  stressed.setZero();
}

void InsideMemory::scale(double by) noexcept {
  g *= by;
  w *= by;
  stiffness *= by;
  stressed *= by;
}

namespace {

// All of an array's indices, from the last, each of its set, turned.
template <class Matrix>
void add_inside(const Matrix& of, const std::array<const MemorySet*, 3>& index,
                const MemoryTurn& turn, double weight, Matrix& sum) noexcept {
  Matrix one = of, other;
  int inner = static_cast<int>(of.size()), outer = 1;
  for (const MemorySet* set : {index[2], index[1], index[0]}) {
    inner /= set->size;
    turn.turn(*set, one.data(), other.data(), inner, outer);
    outer *= set->size;
    one = other;
  }
  sum += weight * one;
}

}  // namespace

void add_turned(const InsideMemory& of, const MemoryTurn& turn, double weight,
                InsideMemory& sum) noexcept {
  const MemorySet &ways = inside_ways(), &now = inside_now(), &before = inside_before();
  add_inside(of.g, {&ways, &now, &before}, turn, weight, sum.g);
  add_inside(of.w, {&ways, &now, &before}, turn, weight, sum.w);
  add_inside(of.stiffness, {&ways, &ways, &now}, turn, weight, sum.stiffness);
  add_inside(of.stressed, {&ways, &ways, &before}, turn, weight, sum.stressed);
}

InsideForce inside_force(const InsideMemory& inside, const MemoryPoint& at, const MemoryVector& h,
                         const InsideAmplitudes& faded, double at_once) noexcept {
  using Square = Eigen::Matrix<double, kInsideFields, kInsideFields>;
  using Way = Eigen::Matrix<double, kInsideFields, 1>;
  const MemoryPart<kInsideNow> n(inside_now(), at);
  const MemoryPart<kInsideBefore> m(inside_before(), at);
  Eigen::Matrix<double, kInsideBefore, 1> remembered;
  for (int t = 0; t < kInsideBefore; ++t)
    remembered[t] = h[inside_before().at[static_cast<std::size_t>(t)]];

  InsideAmplitudes g;
  Eigen::Map<Eigen::Matrix<double, kInsideFields * kInsideNow, 1>>(g.data()).noalias() =
      inside.g * remembered;
  Square A, G;
  Eigen::Map<Eigen::Matrix<double, kInsideFields * kInsideFields, 1>> a(A.data()), s(G.data());
  a.noalias() = inside.stiffness * n.m;
  s.noalias() = inside.stressed * (m.m + remembered);
  const Eigen::LLT<Square> held((1 + at_once) * A + G);
  InsideForce result;
  result.held = held.info() == Eigen::Success;
  if (!result.held) return result;
  const Way x = held.solve(-(g * n.m + A * faded.col(0)));
  result.x = x * n.m.transpose();

  const InsideAmplitudes z = faded + at_once * result.x;
  result.f = n.gradient * (g.transpose() * x);
  result.f += m.gradient *
              (inside.w.transpose() *
               Eigen::Map<const Eigen::Matrix<double, kInsideFields * kInsideNow, 1>>(z.data()));
  // By the change of A with u: x A' (x + z) / 2; of G: x G' x / 2.
  const Square xz = x * (x + z.col(0)).transpose(), xx = x * x.transpose();
  result.f +=
      0.5 * n.gradient *
      (inside.stiffness.transpose() *
       Eigen::Map<const Eigen::Matrix<double, kInsideFields * kInsideFields, 1>>(xz.data()));
  result.f +=
      0.5 * m.gradient *
      (inside.stressed.transpose() *
       Eigen::Map<const Eigen::Matrix<double, kInsideFields * kInsideFields, 1>>(xx.data()));
  if (!result.f.allFinite()) result = {Vec3::Zero(), InsideAmplitudes::Zero(), false};
  return result;
}

}  // namespace hapsim
