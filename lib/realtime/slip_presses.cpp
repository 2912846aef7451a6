#include "realtime/slip_presses.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "realtime/stored_numbers.h"
#include "realtime/strain_mesh.h"

namespace hapsim {
namespace {

constexpr const char* kSlipKind = "hsslip10";
constexpr int kDepths = 15;  // no deeper do elements converge
constexpr double kSlipLeast = 1.0 / 8;
// Standard, of forces: of coarse elements alone, as far as they were off where finer ones were
// pressed too (5 to 6.5 % rms of all motions); and of what finer ones have, over the difference.
constexpr double kCoarseDoubt = 0.06, kFinerDoubt = 0.25;
// Of coarse elements where finer ones ended before, over that difference: of the correction there,
// which goes on, half.
constexpr double kCarriedDoubt = 0.67;
constexpr double kFinerShare = 1.0 / 3;  // of a difference by halving, second order

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

std::size_t depth_index(const Vec3& v) {
  return static_cast<std::size_t>(std::lround(v[0] / kSlipPart)) - 1;
}

// As a held tool's, twice as large away from the rim, which takes a sixth of the time: forces over
// those of a tool that holds converge as regularly.
FullOptions slip_elements(const ContactBase& base, double rim) {
  FullOptions options = strain_elements(base, rim);
  options.growth *= 2;
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
    const std::size_t deepest = depth_index(motions[kSlipIn].way.back()) + 1;
    as_far_as_it_converges([&] {
      while (straight.size() < deepest)
        straight.push_back(
            force(press, Vec3(kSlipPart * static_cast<double>(straight.size() + 1), 0, 0)));
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

// Steps of the ways in that both converged.
int reached_in(const std::vector<SlipMotion>& motions) {
  return static_cast<int>(
      std::min(motions[kSlipIn].force.size(), motions[kSlipInDrawn].force.size()));
}

// What elements half as large have to `coarse` is added to it, and a third more; where those end
// first, the force is made as much larger or smaller as at their last. Returns the root mean square
// of what they differ by, relative.
double extrapolate(const std::vector<SlipMotion>& fine, std::vector<SlipMotion>& coarse) {
  double sum = 0, count = 0;
  std::vector<std::vector<double>> grown;
  for (std::size_t m = 0; m < fine.size(); ++m) {
    double last = 1;
    if (coarse[m].after >= 0 && coarse[m].from >= 1) {
      const std::vector<double>& before = grown[static_cast<std::size_t>(coarse[m].after)];
      if (coarse[m].from <= static_cast<int>(before.size()))
        last = before[static_cast<std::size_t>(coarse[m].from - 1)];
    }
    grown.emplace_back();
    for (std::size_t i = 0; i < coarse[m].force.size(); ++i) {
      Vec3& force = coarse[m].force[i];
      if (i < fine[m].force.size()) {
        const Vec3 halving = fine[m].force[i] - force;
        sum += halving.squaredNorm() / fine[m].force[i].squaredNorm();
        ++count;
        last = 1 + (1 + kFinerShare) * halving[0] / force[0];
        force += (1 + kFinerShare) * halving;
      } else {
        force *= last;
      }
      grown.back().push_back(last);
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

std::string SlipPresses::bytes() const {
  std::vector<double> numbers{friction, doubt, deepest, coarse_doubt, coarse_deepest, seen};
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
  constexpr std::size_t kHead = 6;
  const auto numbers = read_numbers(kSlipKind, bytes);
  if (!numbers || numbers->size() < kHead) return std::nullopt;
  SlipPresses presses;
  presses.friction = (*numbers)[0];
  presses.doubt = (*numbers)[1];
  presses.deepest = (*numbers)[2];
  presses.coarse_doubt = (*numbers)[3];
  presses.coarse_deepest = (*numbers)[4];
  presses.seen = (*numbers)[5];
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
  const int depths = std::min(kDepths, static_cast<int>(sample.into / kSlipStep));
  if (depths < 1) return std::nullopt;
  SlipPresses presses;
  presses.friction = friction;
  presses.motions = planned_slip_ways(sideways(sample), friction, depths, seed);
  const auto press_all = [&](double rim, std::vector<SlipMotion>& motions) {
    return press(body, slip_elements(base, rim), held, slips, sample, tool_radius, friction,
                 motions);
  };
  presses.seen = press_all(1, presses.motions);
  const int reached = reached_in(presses.motions);
  if (reached == 0 || presses.motions[kSlipAcross].force.size() < 4) return std::nullopt;
  presses.coarse_deepest = kSlipStep * reached;
  presses.deepest = kSlipStep * std::min(reached, kSlipNear);
  presses.doubt = presses.coarse_doubt = kCoarseDoubt;
  if (finer) {
    std::vector<SlipMotion> by = presses.motions;
    for (const SlipWay in : {kSlipIn, kSlipInDrawn})
      by[in].way.resize(std::min<std::size_t>(by[in].way.size(), kSlipNear));
    press_all(0.5, by);
    if (const int both = reached_in(by); both > 0) {
      presses.deepest = kSlipStep * std::min(reached, both);
      const double halving = extrapolate(by, presses.motions);
      presses.doubt = kFinerDoubt * halving;
      presses.coarse_doubt = kCarriedDoubt * halving;
    }
  }
  for (SlipMotion& m : presses.motions) m.way.resize(m.force.size());
  return presses;
}

}  // namespace hapsim
