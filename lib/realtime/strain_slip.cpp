#include "realtime/strain_slip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "estimate/least_squares.h"

namespace hapsim {
namespace {

constexpr int kRings = RimSlip::kRings;
// Unknowns: a and b of the rings, g, the logarithms of bounds over the first, of the springs
// between rings, and of that around.
constexpr int kMore = kRings, kReturns = 2 * kRings, kBounds = kReturns + RimSlip::kReturns,
              kBetween = kBounds + kRings - 1, kAround = kBetween + kRings - 1,
              kUnknowns = kAround + 1;
constexpr double kFloor = 0.05;      // of a motion's largest force
constexpr double kResidual = 0.005;  // standard, of what the rings leave
constexpr double kSubstep = 0.1;     // tool radii
constexpr double kDiffer = 1e-3;     // for derivatives
constexpr double kSlippedFar = 0.5;  // tool radii, from which on the contact is elsewhere
constexpr double kSeenAll = 0.95;    // of mu N sideways: then it was seen to slip as a whole
constexpr double kUnseen = 1.3;      // what other motions are off by, over those that were fitted
constexpr double kHandOver = 0.15;   // tool radii, of depth

using StrainState = StrainSlip::State;
enum class Rows { kNear, kDeep };

std::vector<Unknown> unknowns() {
  std::vector<Unknown> all(kUnknowns);
  constexpr std::array<double, kRings> kDrawn{0.02, 0.07, 0.17, 0.37, 0.87};
  for (int j = 0; j < kRings; ++j)
    all[static_cast<std::size_t>(j)] = all[static_cast<std::size_t>(kMore + j)] = {
        kDrawn[static_cast<std::size_t>(j)], -3, 6, 0.1};
  for (int i = kReturns; i < kBounds; ++i) all[static_cast<std::size_t>(i)] = {0.7, 0, 3, 0.1};
  for (int i = kBounds; i < kBetween; ++i) all[static_cast<std::size_t>(i)] = {0, -3, 2, 0.3};
  for (int i = kBetween; i < kUnknowns; ++i)
    all[static_cast<std::size_t>(i)] = {i < kAround ? -1.5 : -2, -6, 3, 0.5};
  return all;
}

RimSlip rings_of(const Eigen::VectorXd& x, double friction) {
  RimSlip rim;
  rim.friction = friction;
  double all = 0;
  for (int j = 0; j < kRings; ++j) {
    const auto i = static_cast<std::size_t>(j);
    rim.drawn[i] = x[j];
    rim.drawn_more[i] = x[kMore + j];
    rim.bound[i] = j == 0 ? 1 : std::exp(x[kBounds + j - 1]);
    all += RimSlip::kWeight[i] * rim.bound[i];
    if (j + 1 < kRings) rim.between[i] = std::exp(x[kBetween + j]);
  }
  for (double& b : rim.bound) b /= all;
  for (int i = 0; i < RimSlip::kReturns; ++i)
    rim.returns[static_cast<std::size_t>(i)] = x[kReturns + i];
  rim.around = std::exp(x[kAround]);
  return rim;
}

// A tool that holds at the sample's place, over the stiffness there and the tool's radius.
class HeldSample {
 public:
  explicit HeldSample(const StrainSample& sample)
      : c_(sample.c), K_(sample.frame * sample.K * sample.frame.transpose()) {
    K_ /= K_(0, 0);
  }
  RimHeld at(double depth, const Eigen::Vector2d& aside) const {
    const Vec3 v(depth, aside[0], aside[1]);
    const Vec3 f = K_ * v + strain_gradient(c_, v);
    const Eigen::Matrix3d K = K_ + strain_hessian(c_, v);
    return {f[0], f.tail<2>(), K.block<1, 2>(0, 1).transpose(), K.bottomRightCorner<2, 2>()};
  }

 private:
  const StrainCoefficients& c_;
  Eigen::Matrix3d K_;
};

RimSlip::Force go(const StrainSlip& slip, const HeldSample& held, const Vec3& from, const Vec3& to,
                  StrainState& state) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kSubstep - 1e-9)));
  RimSlip::Force force;
  for (int i = 1; i <= steps; ++i) {
    const Vec3 v = from + static_cast<double>(i) / steps * (to - from);
    force = slip.step(v[0], v.tail<2>(), state,
                      [&](const Eigen::Vector2d& way) { return held.at(v[0], way); });
  }
  return force;
}

// Residuals of a place, in its motions' order: forces over the larger of the force and the floor.
// Near rows are those until a motion is deeper than slip.near, deep ones the others.
void residuals(const StrainSlip& slip, const SlipPlace& place, Rows rows,
               std::vector<double>& all) {
  const HeldSample held(place.sample);
  struct At {
    Vec3 v = Vec3::Zero();
    StrainState state;
  };
  std::vector<std::vector<At>> been;
  for (const SlipMotion& m : place.presses.motions) {
    been.emplace_back();
    At at;
    if (m.after >= 0) {
      const auto& before = been[static_cast<std::size_t>(m.after)];
      if (m.from < 1 || m.from > static_cast<int>(before.size())) continue;
      at = before[static_cast<std::size_t>(m.from - 1)];
    }
    std::vector<Vec3> asked;
    double largest = 0;
    for (std::size_t i = 0; i < m.force.size(); ++i) {
      const RimHeld straight = held.at(m.way[i][0], Eigen::Vector2d::Zero());
      asked.push_back(m.force[i] * straight.normal);
      asked.back().tail<2>() += straight.along;
      largest = std::max(largest, asked.back().norm());
    }
    for (std::size_t i = 0; i < m.force.size(); ++i) {
      const bool deep = std::max(at.state.deepest, m.way[i][0]) > slip.near.deepest + 1e-9;
      if (deep && rows == Rows::kNear) break;
      const RimSlip::Force f = go(slip, held, at.v, m.way[i], at.state);
      at.v = m.way[i];
      been.back().push_back(at);
      if (deep != (rows == Rows::kDeep)) continue;
      const Vec3 off = (Vec3() << f.normal, f.along).finished() - asked[i];
      const double size = std::max(asked[i].norm(), kFloor * largest);
      for (int c = 0; c < 3; ++c) all.push_back(off[c] / size);
    }
  }
}

struct Fitted {
  std::vector<Unknown> unknowns;
  RimSlip rim;
  double misfit = 0;  // standard, relative, of other motions than those that were fitted
};

// The rings by which the residuals of those rows are least, from `start` on.
Fitted fit(const StrainSlip& slip, const std::vector<SlipPlace>& places, Rows rows,
           const std::vector<Unknown>& start, int threads) {
  const double friction = places.front().presses.friction;
  const auto off = [&](const Eigen::VectorXd& at) {
    std::vector<double> all;
    StrainSlip tried = slip;
    (rows == Rows::kNear ? tried.near : tried.deep).rim = rings_of(at, friction);
    for (const SlipPlace& place : places) residuals(tried, place, rows, all);
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
  };
  // What the motions do not tell stays where it began.
  const auto with_prior = [&](const Eigen::VectorXd& at, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
    constexpr double kPrior = 2.5;
    const Eigen::VectorXd own = off(at) / kResidual;
    r.resize(own.size() + kUnknowns);
    r.head(own.size()) = own;
    for (int i = 0; i < kUnknowns; ++i)
      r[own.size() + i] = (at[i] - start[static_cast<std::size_t>(i)].value) / kPrior;
    if (J == nullptr) return;
    J->setZero(r.size(), kUnknowns);
    in_parallel(kUnknowns, threads, [&](std::size_t k) {
      const auto i = static_cast<Eigen::Index>(k);
      Eigen::VectorXd there = at;
      there[i] += kDiffer;
      J->col(i).head(own.size()) = (off(there) / kResidual - own) / kDiffer;
      (*J)(own.size() + i, i) = 1 / kPrior;
    });
  };
  LeastSquaresOptions options;
  options.max_iterations = 30;
  options.decrease_tolerance = 0.01;
  const Eigen::VectorXd x = minimise(start, with_prior, options).x;
  Fitted fitted{start, rings_of(x, friction)};
  for (int i = 0; i < kUnknowns; ++i) fitted.unknowns[static_cast<std::size_t>(i)].value = x[i];
  const Eigen::VectorXd left = off(x);
  fitted.misfit = kUnseen * std::sqrt(3.0 / static_cast<double>(left.size())) * left.norm();
  return fitted;
}

}  // namespace

void StrainSlip::State::store(double* numbers) const noexcept {
  for (const RimSlip::State* rings : {&near, &deep}) {
    numbers = std::copy_n(rings->slip.data(), rings->slip.size(), numbers);
    numbers = std::copy_n(rings->way.data(), 2, numbers);
  }
  *numbers = deepest;
}

StrainSlip::State StrainSlip::State::load(const double* numbers) noexcept {
  State state;
  for (RimSlip::State* rings : {&state.near, &state.deep}) {
    std::copy_n(numbers, rings->slip.size(), rings->slip.data());
    std::copy_n(numbers + rings->slip.size(), 2, rings->way.data());
    numbers += RimSlip::kNumbers;
  }
  state.deepest = *numbers;
  return state;
}

double StrainSlip::deep_share(double deepest) const noexcept {
  if (deep.deepest <= near.deepest) return 0;
  return std::clamp((deepest - near.deepest) / kHandOver, 0.0, 1.0);
}

bool StrainSlip::within(const State& state, const RimSlip::Force& force) const noexcept {
  const bool borne =
      seen >= kSeenAll || force.along.norm() <= seen * near.rim.friction * force.normal;
  return borne && state.deepest <= deepest() && force.slipped.norm() <= kSlippedFar;
}

double StrainSlip::doubt_of(const State& state, double lost) const noexcept {
  const double share = deep_share(state.deepest);
  const double beyond = state.deepest - deepest();
  return std::hypot((1 - share) * near.doubt + share * deep.doubt,
                    std::clamp(beyond, 0.0, 1.0) * lost);
}

StrainSlip fit_strain_slip(const std::vector<SlipPlace>& places, int threads) {
  StrainSlip slip;
  const SlipPresses& first = places.front().presses;
  slip.near.deepest = first.deepest;
  slip.deep.deepest = first.coarse_deepest;
  slip.seen = 0;
  double elements = 0, coarse = 0;
  for (const SlipPlace& place : places) {
    const SlipPresses& presses = place.presses;
    slip.near.deepest = std::min(slip.near.deepest, presses.deepest);
    slip.deep.deepest = std::min(slip.deep.deepest, presses.coarse_deepest);
    slip.seen = std::max(slip.seen, presses.seen);
    elements = std::max(elements, presses.doubt);
    coarse = std::max(coarse, presses.coarse_doubt);
  }
  slip.seen = std::min(slip.seen, 1.0);
  const Fitted near = fit(slip, places, Rows::kNear, unknowns(), threads);
  slip.near.rim = near.rim;
  slip.near.doubt = std::hypot(near.misfit, elements);
  if (slip.deep.deepest <= slip.near.deepest) return slip;
  const Fitted deep = fit(slip, places, Rows::kDeep, near.unknowns, threads);
  slip.deep.rim = deep.rim;
  slip.deep.doubt = std::hypot(deep.misfit, coarse);
  return slip;
}

}  // namespace hapsim
