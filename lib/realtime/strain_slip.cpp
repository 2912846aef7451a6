#include "realtime/strain_slip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "realtime/stored_numbers.h"
#include "realtime/strain_mesh.h"

namespace hapsim {
namespace {

constexpr const char* kSlipKind = "hsslip05";
constexpr int kAsideAt = 3;  // the depth at which the tool is pushed aside, in steps
constexpr int kBack = 3;     // steps aside
constexpr double kSlipLeast = 1.0 / 8;
constexpr int kFinerDepths = 5;     // no deeper do finer elements converge
constexpr double kMostSlipped = 3;  // of the rim, over what it had where a retreat was solved
// Standard, of ratios: of coarse elements alone, and a depth that finer ones do not reach.
constexpr double kCoarseDoubt = 0.02, kDeeperDoubt = 0.01;
constexpr double kFinerShare = 1.0 / 3;  // of a difference by halving, second order

// Straight down, drawn, and aside: normal forces, and for the last both.
struct Pressed {
  std::vector<double> held, straight, drawn, retreat;
  std::vector<double> aside_normal, aside;  // by aside_step(), from 0 on
  double back = 0;                          // what kBack steps back take from the last
};

// Steps aside in tool radii, eight of which are enough for the tool to slip as a whole, and aside
// over depth of a tool that is drawn, which does so too.
double aside_step(double friction) {
  return std::clamp(friction / 8, 0.002, 0.1);
}
double drawn_aside(double friction) {
  return std::clamp(5 * friction, 1.0, 4.0);
}

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

Pressed press_slipping(const TetMesh& body, const ContactBase& base, const Model& held,
                       const Model& slips, const StrainSample& sample, double radius,
                       double friction, double finer, int depths) {
  FullOptions options = strain_elements(base, finer);
  options.solve.least_step = kSlipLeast;
  Pressed p;
  const Eigen::Vector2d way = sideways(sample);
  const double aside = aside_step(friction);
  // Normal force, and that along the way aside.
  const auto force = [&](FullPress& press, double d, double side) -> Eigen::Vector2d {
    const Vec3 v(d, side * way[0], side * way[1]);
    const Vec3 f = -sample.frame * press.step(radius * sample.frame.transpose() * v, 0);
    return {f[0], way.dot(f.tail<2>())};
  };
  {
    FullPress press(body, held, sample.point, radius, options);
    as_far_as_it_converges([&] {
      for (int i = 1; i <= depths; ++i) p.held.push_back(force(press, StrainSlip::kStep * i, 0)[0]);
    });
  }
  FullPress press(body, slips, sample.point, radius, options);
  ToolBody::State at = press.state();
  as_far_as_it_converges([&] {
    for (int i = 1; i <= static_cast<int>(p.held.size()); ++i) {
      p.straight.push_back(force(press, StrainSlip::kStep * i, 0)[0]);
      if (i <= kAsideAt) at = press.state();
    }
  });
  const int straight = std::min<int>(kAsideAt, static_cast<int>(p.straight.size()));
  if (straight == 0) return p;
  press.restore(at);
  p.aside_normal.push_back(p.straight[static_cast<std::size_t>(straight - 1)]);
  p.aside.push_back(0);
  as_far_as_it_converges([&] {
    for (int i = 1; i <= StrainSlip::kSliders; ++i) {
      const Eigen::Vector2d f = force(press, StrainSlip::kStep * straight, aside * i);
      p.aside_normal.push_back(f[0]);
      p.aside.push_back(f[1]);
    }
    const Eigen::Vector2d back =
        force(press, StrainSlip::kStep * straight, aside * (StrainSlip::kSliders - kBack));
    p.back = p.aside.back() - back[1];
  });
  press.restore(at);
  as_far_as_it_converges([&] {
    for (int i = StrainSlip::kRetreat - 1; i > 0; --i)
      p.retreat.push_back(
          force(press, StrainSlip::kStep * straight * i / StrainSlip::kRetreat, 0)[0]);
  });
  press.reset();
  as_far_as_it_converges([&] {
    for (int i = 1; i <= static_cast<int>(p.straight.size()); ++i)
      p.drawn.push_back(
          force(press, StrainSlip::kStep * i, drawn_aside(friction) * StrainSlip::kStep * i)[0]);
  });
  return p;
}

// The held tool's force by the sample, normal and aside, over its normal force straight down there.
Eigen::Vector2d held_force(const StrainSample& sample, double d, double side) {
  const Eigen::Matrix3d K = sample.frame * sample.K * sample.frame.transpose();
  const Eigen::Vector2d way = sideways(sample);
  const auto at = [&](double p) -> Eigen::Vector2d {
    const Vec3 v(d, p * way[0], p * way[1]);
    const Vec3 f = K * v / K(0, 0) + strain_gradient(sample.c, v);
    return {f[0], way.dot(f.tail<2>())};
  };
  return at(side) / at(0)[0];
}

double between(const double* values, double at, int count) {
  const double inside = std::clamp(at, 0.0, count - 1.0);
  const int k = std::min(static_cast<int>(inside), count - 2);
  return values[k] + (inside - k) * (values[k + 1] - values[k]);
}

// Shares and bounds from what the tool bears aside: f = sum of min(share x, share bound), as the
// polygon through what was solved has it, made concave.
void fit_sliders(const StrainSample& sample, const Pressed& p, StrainSlip& slip) {
  const double d = StrainSlip::kStep * std::min<int>(kAsideAt, static_cast<int>(p.straight.size()));
  const double held = p.held[static_cast<std::size_t>(std::lround(d / StrainSlip::kStep)) - 1];
  const double step = aside_step(slip.friction);
  std::vector<double> x{0}, f{0};
  for (std::size_t i = 1; i < p.aside.size(); ++i) {
    const double most = slip.friction * p.aside_normal[i];
    const double would = held * held_force(sample, d, step * static_cast<double>(i))[1];
    x.push_back(would / most);
    f.push_back(std::min(1.0, p.aside[i] / most));
  }
  std::vector<double> slope;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double s = (f[i] - f[i - 1]) / std::max(x[i] - x[i - 1], 1e-9);
    slope.push_back(std::clamp(s, 0.0, slope.empty() ? 1.0 : slope.back()));
  }
  slope.push_back(0);
  double all = 0, shares = 0;
  for (std::size_t j = 0; j + 1 < slope.size(); ++j) {
    slip.share[j] = slope[j] - slope[j + 1];
    slip.bound[j] = x[j + 1];
    all += slip.share[j] * slip.bound[j];
    shares += slip.share[j];
  }
  // Together they bear mu N at most: the last ones' bounds, beyond what was solved, see to that.
  for (double& b : slip.bound) b /= std::max(all, 1e-9);
  const double would = held * (held_force(sample, d, 0.5 * step * kBack)[1] -
                               held_force(sample, d, -0.5 * step * kBack)[1]);
  slip.share_slid = std::clamp(p.back > 0 ? p.back / would : shares, 0.3, 1.0);
  slip.seen = f.back();
}

}  // namespace

double StrainSlip::at(const std::array<double, kDepths>& table, double depth) const noexcept {
  const double where = std::clamp(depth / kStep, 0.0, static_cast<double>(reached));
  const auto above =
      std::min(static_cast<std::size_t>(where), static_cast<std::size_t>(reached - 1));
  const double below = above > 0 ? table[above - 1] : 1;
  return below + (where - static_cast<double>(above)) * (table[above] - below);
}

double StrainSlip::normal(double depth, double deepest, double slid) const noexcept {
  const double own = (1 - slid) * at(straight, depth) + slid * at(sliding, depth);
  if (!(deepest > depth && retreat_from > 0)) return own;
  // As far as the rim has slipped on the way in.
  const double slipped =
      std::clamp((1 - at(straight, deepest)) / std::max(1 - at(straight, retreat_from), 1e-3), 0.0,
                 kMostSlipped);
  const double share_in = std::clamp(depth / deepest, 0.0, 1.0) * kRetreat;
  const auto k =
      std::min(static_cast<std::size_t>(share_in), static_cast<std::size_t>(kRetreat - 1));
  const double above = k + 1 < kRetreat ? retreat[k + 1] : 0;
  return own *
         (1 - slipped * (retreat[k] + (share_in - static_cast<double>(k)) * (above - retreat[k])));
}

double StrainSlip::sticks(double depth) const noexcept {
  double there = 0;
  for (const double s : share) there += s;
  const double slipped = 1 - at(straight, aside_at);
  if (!(slipped > 0 && there > 0)) return 1;
  return std::max(0.3, 1 - (1 - there) * (1 - at(straight, depth)) / slipped) / there;
}

double StrainSlip::slid_at(double rate) noexcept {
  const double q = std::clamp(rate, 0.0, 1.0);
  return 0.3 * q + 0.7 * (1 - std::sqrt(1 - q * q));
}

double StrainSlip::doubt_at(double depth) const noexcept {
  const double at = std::clamp(depth / kStep, 0.0, static_cast<double>(reached));
  const auto above = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(reached - 1));
  return doubt[above];
}

StrainSlip StrainSlip::with(const StrainSlip& other) const {
  StrainSlip mean = *this;
  mean.reached = std::min(reached, other.reached);
  const auto halve = [](auto& a, const auto& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = 0.5 * (a[i] + b[i]);
  };
  halve(mean.straight, other.straight);
  halve(mean.sliding, other.sliding);
  halve(mean.doubt, other.doubt);
  for (std::size_t i = 0; i < mean.doubt.size(); ++i)
    mean.doubt[i] = std::hypot(mean.doubt[i], 0.5 * (straight[i] - other.straight[i]),
                               0.5 * (sliding[i] - other.sliding[i]));
  return mean;
}

std::string StrainSlip::bytes() const {
  std::vector<double> numbers{
      friction, static_cast<double>(reached), retreat_from, aside_at, share_slid, seen};
  for (const auto* a : {&straight, &sliding, &doubt, &share, &bound})
    numbers.insert(numbers.end(), a->begin(), a->end());
  numbers.insert(numbers.end(), retreat.begin(), retreat.end());
  return stored_numbers(kSlipKind, numbers);
}

std::optional<StrainSlip> StrainSlip::read(const std::string& bytes) {
  constexpr std::size_t kNumbers = 6 + 3 * kDepths + 2 * kSliders + kRetreat;
  const auto stored = read_numbers(kSlipKind, bytes);
  if (!stored || stored->size() != kNumbers) return std::nullopt;
  const std::vector<double>& numbers = *stored;
  StrainSlip s;
  s.friction = numbers[0];
  s.reached = static_cast<int>(numbers[1]);
  s.retreat_from = numbers[2];
  s.aside_at = numbers[3];
  s.share_slid = numbers[4];
  s.seen = numbers[5];
  const double* next = numbers.data() + 6;
  for (auto* a : {&s.straight, &s.sliding, &s.doubt, &s.share, &s.bound}) {
    std::copy_n(next, a->size(), a->begin());
    next += a->size();
  }
  std::copy_n(next, s.retreat.size(), s.retreat.begin());
  return s;
}

std::optional<StrainSlip> solve_strain_slip(const TetMesh& body, const ContactBase& base,
                                            const Model& held, const Model& slips,
                                            const StrainSample& sample, double tool_radius,
                                            double friction, bool finer) {
  static_assert(StrainSlip::kDepths == StrainSlip::kSliders);
  const int depths =
      std::min(StrainSlip::kDepths, static_cast<int>(sample.into / StrainSlip::kStep));
  if (depths < 1) return std::nullopt;
  const Pressed coarse =
      press_slipping(body, base, held, slips, sample, tool_radius, friction, 1, depths);
  if (coarse.straight.empty()) return std::nullopt;
  const Pressed fine =
      finer ? press_slipping(
                  body, base, held, slips, sample, tool_radius, friction, 0.5,
                  std::min({depths, kFinerDepths, static_cast<int>(coarse.straight.size())}))
            : coarse;
  StrainSlip slip;
  slip.friction = friction;
  slip.aside_at =
      StrainSlip::kStep * std::min<int>(kAsideAt, static_cast<int>(fine.straight.size()));
  // A table of the coarse elements, by the finer ones as far as they go, and from there by as much
  // as they differ last.
  const auto table = [](const std::vector<double>& of, const std::vector<double>& over,
                        std::size_t i) { return of[i] / over[i]; };
  const std::size_t common = std::min(coarse.straight.size(), coarse.drawn.size());
  const std::size_t both = std::min({fine.straight.size(), fine.drawn.size(), common});
  if (both == 0 || fine.aside.size() < 3) return std::nullopt;
  fit_sliders(sample, fine, slip);
  if (!(slip.sticks(slip.aside_at) > 0 && slip.seen > 0)) return std::nullopt;
  // Where a tool that bears mu N as a whole would hold, and what the sample says of that.
  const auto aside = [&](std::size_t i, double normal) {
    const double d = StrainSlip::kStep * static_cast<double>(i + 1),
                 would = friction * normal / slip.share_slid;
    double low = 0, high = strain_side(d, sample.aside);
    for (int k = 0; k < 30; ++k) {
      const double side = 0.5 * (low + high);
      (held_force(sample, d, side)[1] < would ? low : high) = side;
    }
    return held_force(sample, d, low)[0];
  };
  double rest_straight = 0, rest_drawn = 0, last = 0;
  for (std::size_t i = 0; i < common; ++i) {
    double straight = table(coarse.straight, coarse.held, i),
           drawn = table(coarse.drawn, coarse.held, i);
    if (i < both) {
      const double s = table(fine.straight, fine.held, i), d = table(fine.drawn, fine.held, i);
      last = std::max(std::abs(s - straight), std::abs(d - drawn));
      rest_straight = s + kFinerShare * (s - straight) - straight;
      rest_drawn = d + kFinerShare * (d - drawn) - drawn;
    }
    straight += rest_straight;
    drawn += rest_drawn;
    slip.straight[i] = straight;
    slip.sliding[i] = drawn / aside(i, drawn);
    slip.doubt[i] = (finer ? 0.5 * last : kCoarseDoubt) +
                    (i < both ? 0 : kDeeperDoubt * static_cast<double>(i + 1 - both));
  }
  slip.reached = static_cast<int>(common);
  const std::size_t from = std::min<std::size_t>(kAsideAt, fine.straight.size()) - 1;
  if (static_cast<int>(fine.retreat.size()) == StrainSlip::kRetreat - 1 &&
      slip.straight[from] < 1) {
    slip.retreat_from = StrainSlip::kStep * static_cast<double>(from + 1);
    for (int k = 1; k < StrainSlip::kRetreat; ++k) {
      // The way in there, between the depths that were solved.
      const double depth = slip.retreat_from * k / StrainSlip::kRetreat;
      std::vector<double> in{0};
      in.insert(in.end(), fine.straight.begin(), fine.straight.end());
      const double was = between(in.data(), depth / StrainSlip::kStep, static_cast<int>(in.size()));
      slip.retreat[static_cast<std::size_t>(k)] =
          1 - fine.retreat[static_cast<std::size_t>(StrainSlip::kRetreat - 1 - k)] / was;
    }
    slip.retreat[0] = slip.retreat[1];
  }
  return slip;
}

}  // namespace hapsim
