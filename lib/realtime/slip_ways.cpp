#include "realtime/slip_ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/random.h"

namespace hapsim {
namespace {

constexpr int kOutFrom = 4, kAsideAt = 3;      // steps of the way in
constexpr int kCorners = 5, kCornersDeep = 3;  // ways from corner to corner
constexpr double kDeepShare = 0.95;            // of the deepest step, of those

double at_a_part(double depth) {
  return kSlipPart * std::max(1.0, std::round(depth / kSlipPart));
}

// A depth, and so far aside in a direction.
Vec3 towards(double depth, double far, double direction) {
  return {depth, far * std::cos(direction), far * std::sin(direction)};
}

double any_direction(Random& random) {
  return 2 * std::numbers::pi * random.uniform();
}

double between(double low, double high, Random& random) {
  return low + (high - low) * random.uniform();
}

// From corner to corner, drawn at random up to `deep` and aside by up to `aside`, and nearly out at
// last.
SlipMotion wandering(double deep, double aside, Random& random) {
  constexpr int kLegs = 4;
  constexpr double kShallow = 0.3, kOut = 0.15;  // of `deep`
  constexpr double kApart = 0.12;                // tool radii
  SlipMotion motion;
  Vec3 from = Vec3::Zero();
  for (int leg = 1; leg <= kLegs; ++leg) {
    const double depth = deep * (leg < kLegs ? between(kShallow, 1, random) : kOut);
    const double far = aside * std::sqrt(random.uniform());
    const Vec3 to = towards(depth, far, any_direction(random));
    const int steps = 1 + static_cast<int>((to - from).norm() / kApart);
    for (int i = 1; i <= steps; ++i) {
      const Vec3 v = from + static_cast<double>(i) / steps * (to - from);
      motion.way.emplace_back(at_a_part(v[0]), v[1], v[2]);
    }
    from = to;
  }
  return motion;
}

// In and aside to a circle, and nearly twice around it at that depth.
SlipMotion circling(double deep, double aside, Random& random) {
  constexpr int kSteps = 22;
  constexpr double kTurn = 0.5;  // of a step
  SlipMotion motion;
  const double depth = at_a_part(deep * between(0.5, 0.9, random));
  const double far = aside * between(0.4, 0.7, random);
  const double start = any_direction(random);
  const double turn = random.coin() ? kTurn : -kTurn;
  const int in = std::max(1, static_cast<int>(std::lround(depth / (2 * kSlipPart))));
  for (int i = 1; i <= in; ++i)
    motion.way.push_back(towards(at_a_part(depth * i / in), far * i / in, start));
  for (int i = 1; i <= kSteps; ++i) motion.way.push_back(towards(depth, far, start + turn * i));
  return motion;
}

// In and out while it goes on aside.
SlipMotion pecking(double deep, double aside, Random& random) {
  constexpr int kTimes = 3;
  constexpr std::array<double, 5> kDepths{0.4, 0.75, 1, 0.65, 0.2};  // of the deepest
  SlipMotion motion;
  const double depth = deep * between(0.75, 1, random);
  const double far = aside * between(0.4, 1, random);
  const double direction = any_direction(random);
  constexpr std::size_t kAll = kTimes * kDepths.size();
  for (std::size_t i = 0; i < kAll; ++i)
    motion.way.push_back(towards(at_a_part(depth * kDepths[i % kDepths.size()]),
                                 far * static_cast<double>(i) / (kAll - 1), direction));
  return motion;
}

}  // namespace

// A tool that is pushed aside by friction * depth slips hardly, by 1.7 of that as a whole nearly.
std::vector<SlipMotion> planned_slip_ways(const Eigen::Vector2d& across, double friction,
                                          int depths, std::uint64_t seed) {
  constexpr double kDrawnBy = 1.7;                            // of friction, aside over depth
  constexpr std::array<double, 8> kSides{0.25, 0.5, 0.75, 1,  // of what slips as a whole
                                         0.7,  0.3, -0.1, -0.5};
  const auto at = [&](double depth, double side) {
    return Vec3(depth, side * across[0], side * across[1]);
  };
  const double step = kSlipStep, by = std::clamp(kDrawnBy * friction, 0.05, 2.0);
  const double aside = std::clamp(friction, 0.016, 0.8);
  std::vector<SlipMotion> all(kSlipFixed);
  all[kSlipOut] = {kSlipIn, std::min(kOutFrom, depths), {}, {}};
  all[kSlipAcross] = {kSlipIn, std::min(kAsideAt, depths), {}, {}};
  all[kSlipOutDrawn] = {kSlipInDrawn, std::min(kOutFrom, depths), {}, {}};
  for (int i = 1; i <= depths; ++i) {
    all[kSlipIn].way.push_back(at(step * i, 0));
    all[kSlipInDrawn].way.push_back(at(step * i, by * step * i));
  }
  all[kSlipOutDeep] = {kSlipIn, depths, {}, {}};
  all[kSlipOutDrawnDeep] = {kSlipInDrawn, depths, {}, {}};
  for (const auto& [straight, drawn] :
       {std::pair{kSlipOut, kSlipOutDrawn}, {kSlipOutDeep, kSlipOutDrawnDeep}})
    for (int i = all[straight].from - 1; i >= 1; --i) {
      all[straight].way.push_back(at(step * i, 0));
      all[drawn].way.push_back(at(step * i, by * step * i));
    }
  for (const double side : kSides)
    all[kSlipAcross].way.push_back(at(step * all[kSlipAcross].from, aside * side));
  Random random(seed);
  const double deep = std::min(kSlipWayDepth, step * depths);
  for (int i = 0; i < kCorners; ++i) all.push_back(wandering(deep, aside, random));
  all.push_back(circling(deep, aside, random));
  all.push_back(pecking(deep, aside, random));
  if (depths <= kSlipNear) return all;
  const double deepest = kDeepShare * step * depths;  // there a tool holds farther aside
  for (int i = 0; i < kCornersDeep; ++i) all.push_back(wandering(deepest, 2 * aside, random));
  all.push_back(circling(deepest, 2 * aside, random));
  all.push_back(pecking(deepest, 2 * aside, random));
  return all;
}

}  // namespace hapsim
