// What a fast source of forces misses by law, as the slow one has taught it on other presses.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

// The force [N] to be added to the fast one: for each component the sum of weights times the
// monomials of the displacement's components (to the third degree, over their largest values in
// the lessons) and what Maxwell elements of two times keep of these. Beyond the lessons'
// displacements it is level.
struct TaughtCorrection {
  static constexpr std::size_t kTerms = 13, kTimes = 2, kWeights = kTerms * (1 + kTimes);
  using Terms = std::array<double, kTerms>;

  Vec3 scale = Vec3::Zero();  // of the displacement [m]; zero: nothing was taught
  // Contacts farther from `place` than `reach` [m] were not in the lessons: nothing is known there.
  Vec3 place = Vec3::Zero();
  double reach = 0;
  std::array<double, kTimes> time{1, 1};                 // [s]
  std::array<std::array<double, kWeights>, 3> weight{};  // [N]
  bool taught() const { return scale.squaredNorm() > 0; }
  bool holds_at(const Vec3& contact) const { return (contact - place).norm() <= reach; }
  Terms terms(const Vec3& u) const noexcept;
};

// The correction along a press. Allocates nothing.
class TaughtForce {
 public:
  explicit TaughtForce(const TaughtCorrection& correction) : correction_(correction) {}
  void begin() noexcept { begun_ = false; }  // relaxed
  // The next sample: displacement u [m], dt [s] after the last one.
  Vec3 step(double dt, const Vec3& u) noexcept;
  // What the weights are of, after a step.
  const std::array<double, TaughtCorrection::kWeights>& features() const { return features_; }

 private:
  TaughtCorrection correction_;
  TaughtCorrection::Terms last_{};
  std::array<double, TaughtCorrection::kWeights> features_{};
  bool begun_ = false;
};

// A press of a lesson: the fast source's samples, and slow forces at times of their own.
struct LessonPress {
  Vec3 contact = Vec3::Zero();
  std::vector<double> t;
  std::vector<Vec3> u, fast;
  std::vector<double> slow_t;  // within t
  std::vector<Vec3> slow;
};

// What lessons teach: the correction, and for each press what all other presses teach of it
// [N, one a sample]. Weights by ridge regression, the ridge of each component chosen by presses
// left out; a component is taught where their error falls by a twentieth at least. Nothing of
// fewer than four presses. It holds where they were and half a tool's radius [m] about.
struct Taught {
  TaughtCorrection correction;
  std::vector<std::vector<Vec3>> by_others;  // by press
};
Taught teach(const std::vector<LessonPress>& lessons, double tool_radius);

}  // namespace hapsim
