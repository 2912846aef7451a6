#include "realtime/slip_presses.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "realtime/stored_numbers.h"
#include "realtime/strain_mesh.h"

namespace hapsim {
namespace {

constexpr const char* kSlipKind = "hsslip09";
constexpr int kDepths = 8, kFinerDepths = 5;  // no deeper do finer elements converge
constexpr int kOutFrom = 4, kAsideAt = 3;     // steps of the way in
constexpr int kWays = 5;                      // drawn at random
constexpr double kWayDepth = 0.68;            // tool radii: finer elements converge there mostly
// A step of the depth is of so many at which a tool that holds is pressed.
constexpr int kParts = 3;
constexpr double kPart = SlipPresses::kStep / kParts;
constexpr double kSlipLeast = 1.0 / 8;
// Standard, of forces: of coarse elements alone, and of what finer ones have, over the difference.
constexpr double kCoarseDoubt = 0.02, kFinerDoubt = 0.25;
constexpr double kFinerShare = 1.0 / 3;  // of a difference by halving, second order
enum Which { kIn, kOutAgain, kAcross, kInDrawn, kOutDrawn, kMotions };

template <class Step>
void as_far_as_it_converges(const Step& step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kNoConvergence) throw;
  }
}

// Along the surface, in the sample's frame, where the way in has no part: so that the tool is not
// pushed aside by it.
Eigen::Vector2d sideways(const StrainSample& sample) {
  const Eigen::Matrix3d K = sample.frame * sample.K * sample.frame.transpose();
  const Eigen::Vector2d couples(K(1, 0), K(2, 0));
  if (couples.norm() < 1e-6 * K(0, 0)) return Eigen::Vector2d::UnitX();
  return Eigen::Vector2d(-couples[1], couples[0]).normalized();
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
    const double depth = deep * (leg < kLegs ? kShallow + (1 - kShallow) * random.uniform() : kOut);
    const double far = aside * std::sqrt(random.uniform()),
                 turn = 2 * std::numbers::pi * random.uniform();
    const Vec3 to(depth, far * std::cos(turn), far * std::sin(turn));
    const int steps = 1 + static_cast<int>((to - from).norm() / kApart);
    for (int i = 1; i <= steps; ++i) {
      Vec3 v = from + static_cast<double>(i) / steps * (to - from);
      v[0] = kPart * std::max(1.0, std::round(v[0] / kPart));
      motion.way.push_back(v);
    }
    from = to;
  }
  return motion;
}

// All that is asked of `depths` steps in. A tool that is pushed aside by friction * depth slips
// hardly, by 1.7 of that as a whole nearly.
std::vector<SlipMotion> planned(const StrainSample& sample, double friction, int depths,
                                std::uint64_t seed) {
  constexpr double kDrawnBy = 1.7;                            // of friction, aside over depth
  constexpr std::array<double, 8> kSides{0.25, 0.5, 0.75, 1,  // of what slips as a whole
                                         0.7,  0.3, -0.1, -0.5};
  const Eigen::Vector2d way = sideways(sample);
  const auto at = [&](double depth, double side) {
    return Vec3(depth, side * way[0], side * way[1]);
  };
  const double step = SlipPresses::kStep, by = std::clamp(kDrawnBy * friction, 0.05, 2.0);
  const double aside = std::clamp(friction, 0.016, 0.8);
  std::vector<SlipMotion> all(kMotions);
  all[kOutAgain] = {kIn, std::min(kOutFrom, depths), {}, {}};
  all[kAcross] = {kIn, std::min(kAsideAt, depths), {}, {}};
  all[kOutDrawn] = {kInDrawn, std::min(kOutFrom, depths), {}, {}};
  for (int i = 1; i <= depths; ++i) {
    all[kIn].way.push_back(at(step * i, 0));
    all[kInDrawn].way.push_back(at(step * i, by * step * i));
  }
  for (int i = all[kOutAgain].from - 1; i >= 1; --i) {
    all[kOutAgain].way.push_back(at(step * i, 0));
    all[kOutDrawn].way.push_back(at(step * i, by * step * i));
  }
  for (const double side : kSides)
    all[kAcross].way.push_back(at(step * all[kAcross].from, aside * side));
  Random random(seed);
  const double deep = std::min(kWayDepth, step * depths);
  for (int i = 0; i < kWays; ++i) all.push_back(wandering(deep, aside, random));
  return all;
}

std::size_t depth_index(const Vec3& v) {
  return static_cast<std::size_t>(std::lround(v[0] / kPart)) - 1;
}

// As a held tool's; where two meshes are compared twice as large away from the rim, which takes a
// sixth of the time: forces of these converge as regularly.
FullOptions slip_elements(const ContactBase& base, double rim, double growth) {
  FullOptions options = strain_elements(base, rim);
  options.growth *= growth;
  options.solve.least_step = kSlipLeast;
  return options;
}

// The motions' forces by one mesh, each as far as it converges; returns how much the tool bore
// sideways at most, of mu N.
double press(const TetMesh& body, const FullOptions& options, const Model& held, const Model& slips,
             const StrainSample& sample, double radius, double friction,
             std::vector<SlipMotion>& motions) {
  double seen = 0;
  const auto force = [&](FullPress& press, const Vec3& v) -> Vec3 {
    return -sample.frame * press.step(radius * sample.frame.transpose() * v, 0);
  };
  std::vector<Vec3> straight;
  {
    FullPress press(body, held, sample.point, radius, options);
    const std::size_t deepest = depth_index(motions[kIn].way.back()) + 1;
    as_far_as_it_converges([&] {
      while (straight.size() < deepest)
        straight.push_back(
            force(press, Vec3(kPart * static_cast<double>(straight.size() + 1), 0, 0)));
    });
  }
  FullPress press(body, slips, sample.point, radius, options);
  std::vector<std::vector<ToolBody::State>> states(motions.size());
  for (std::size_t m = 0; m < motions.size(); ++m) {
    SlipMotion& motion = motions[m];
    motion.force.clear();
    if (motion.after < 0) {
      press.reset();
    } else {
      const auto& before = states[static_cast<std::size_t>(motion.after)];
      if (static_cast<int>(before.size()) < motion.from || motion.from < 1) continue;
      press.restore(before[static_cast<std::size_t>(motion.from - 1)]);
    }
    as_far_as_it_converges([&] {
      for (const Vec3& v : motion.way) {
        if (depth_index(v) >= straight.size()) break;
        const Vec3& there = straight[depth_index(v)];
        const Vec3 f = force(press, v);
        seen = std::max(seen, f.tail<2>().norm() / (friction * std::max(f[0], 1e-9 * there[0])));
        motion.force.push_back((f - Vec3(0, there[1], there[2])) / there[0]);
        states[m].push_back(press.state());
      }
    });
  }
  return seen;
}

}  // namespace

std::string SlipPresses::bytes() const {
  std::vector<double> numbers{friction, doubt, deepest, seen};
  for (const SlipMotion& m : motions) {
    numbers.insert(numbers.end(), {static_cast<double>(m.after), static_cast<double>(m.from),
                                   static_cast<double>(m.force.size())});
    for (std::size_t i = 0; i < m.force.size(); ++i) {
      numbers.insert(numbers.end(), m.way[i].begin(), m.way[i].end());
      numbers.insert(numbers.end(), m.force[i].begin(), m.force[i].end());
    }
  }
  return stored_numbers(kSlipKind, numbers);
}

std::optional<SlipPresses> SlipPresses::read(const std::string& bytes) {
  constexpr std::size_t kHead = 4;
  const auto numbers = read_numbers(kSlipKind, bytes);
  if (!numbers || numbers->size() < kHead) return std::nullopt;
  SlipPresses presses;
  presses.friction = (*numbers)[0];
  presses.doubt = (*numbers)[1];
  presses.deepest = (*numbers)[2];
  presses.seen = (*numbers)[3];
  for (std::size_t at = kHead; at + 3 <= numbers->size();) {
    const double* head = numbers->data() + at;
    const auto count = static_cast<std::size_t>(head[2]);
    at += 3;
    if (numbers->size() < at + 6 * count) return std::nullopt;
    SlipMotion m{static_cast<int>(head[0]), static_cast<int>(head[1]), {}, {}};
    if (m.after >= static_cast<int>(presses.motions.size())) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i, at += 6) {
      m.way.push_back(Eigen::Map<const Vec3>(numbers->data() + at));
      m.force.push_back(Eigen::Map<const Vec3>(numbers->data() + at + 3));
    }
    presses.motions.push_back(std::move(m));
  }
  return presses;
}

std::optional<SlipPresses> press_slipping(const TetMesh& body, const ContactBase& base,
                                          const Model& held, const Model& slips,
                                          const StrainSample& sample, double tool_radius,
                                          double friction, std::uint64_t seed, bool finer) {
  const int depths = std::min(kDepths, static_cast<int>(sample.into / SlipPresses::kStep));
  if (depths < 1) return std::nullopt;
  const double growth = finer ? 2 : 1;
  const FullOptions options = slip_elements(base, 1, growth);
  SlipPresses presses;
  presses.friction = friction;
  presses.motions = planned(sample, friction, depths, seed);
  presses.seen = press(body, options, held, slips, sample, tool_radius, friction, presses.motions);
  const std::size_t reached =
      std::min(presses.motions[kIn].force.size(), presses.motions[kInDrawn].force.size());
  if (reached == 0 || presses.motions[kAcross].force.size() < 4) return std::nullopt;
  presses.deepest = SlipPresses::kStep * static_cast<double>(reached);
  presses.doubt = kCoarseDoubt;
  if (finer) {
    const FullOptions fine = slip_elements(base, 0.5, growth);
    std::vector<SlipMotion> by = presses.motions;
    for (const Which in : {kIn, kInDrawn})
      by[in].way.resize(std::min<std::size_t>(by[in].way.size(), kFinerDepths));
    press(body, fine, held, slips, sample, tool_radius, friction, by);
    double sum = 0, count = 0;
    for (std::size_t m = 0; m < by.size(); ++m) {
      std::vector<Vec3>& coarse = presses.motions[m].force;
      Vec3 rest = Vec3::Zero();  // beyond what finer elements reach, as last
      for (std::size_t i = 0; i < coarse.size(); ++i) {
        if (i < by[m].force.size()) {
          const Vec3 halving = by[m].force[i] - coarse[i];
          rest = (1 + kFinerShare) * halving;
          sum += halving.squaredNorm() / by[m].force[i].squaredNorm();
          ++count;
        }
        coarse[i] += rest;
      }
    }
    if (count > 0) presses.doubt = kFinerDoubt * std::sqrt(sum / count);
  }
  for (SlipMotion& m : presses.motions) m.way.resize(m.force.size());
  return presses;
}

}  // namespace hapsim
