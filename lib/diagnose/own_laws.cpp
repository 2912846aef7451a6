#include "diagnose/own_laws.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/kind_laws.h"
#include "diagnose/law_columns.h"
#include "diagnose/left_over.h"
#include "diagnose/unseen_share.h"

namespace hapsim {
namespace {

constexpr std::size_t kStretch = 8;  // samples that are left out, of three times as many
constexpr double kNearlyAll = 0.9, kMostly = 0.8;
constexpr double kAll = 0.95;  // of a force of any direction, in which much else lies

struct PressSamples {
  std::size_t from = 0, to = 0;  // samples
  Vec3 place, way;               // where; the way to its deepest sample
  Vec3 gain;                     // of the load's size
  double load = 0;               // sum of squares [N^2]
};

std::vector<PressSamples> split_presses(const LawSamples& s, const Eigen::VectorXd& residual) {
  std::vector<PressSamples> presses;
  for (std::size_t from = 0, to = 0; from < s.kept.size(); from = to) {
    PressSamples press{from, from, s.place.col(static_cast<Eigen::Index>(from)), Vec3::Zero(),
                       Vec3::Zero()};
    double deepest = 0;
    for (to = from; to < s.kept.size() && s.press[to] == s.press[from]; ++to) {
      const auto i = static_cast<Eigen::Index>(to);
      const double load = s.f.col(i).norm();
      press.gain += load * residual.segment<3>(3 * i);
      press.load += load * load;
      if (s.depth[i] < deepest) continue;
      deepest = s.depth[i];
      press.way = s.u.col(i);
    }
    press.to = to;
    if (press.load > 0) press.gain /= press.load;
    presses.push_back(press);
  }
  return presses;
}

double unforetold(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                  const std::vector<PressSamples>& presses) {
  double left = 0;
  for (const PressSamples& press : presses) {
    std::vector<int> parts;
    for (std::size_t k = press.from; k < press.to; ++k)
      parts.push_back(static_cast<int>((k - press.from) / kStretch % 3));
    const auto first = 3 * static_cast<Eigen::Index>(press.from),
               count = 3 * static_cast<Eigen::Index>(press.to - press.from);
    left +=
        unforetold_squares(columns.middleRows(first, count), residual.segment(first, count), parts)
            .sum();
  }
  return left;
}

law::Columns loads(const LawSamples& s) {
  law::Columns c(3, LawSamples::Vectors::Zero(3, s.f.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis) = s.f.colwise().norm();
  return c;
}

// Of where in a press a sample is, a knot for each two stretches.
std::vector<law::Column> moments(const LawSamples& s, const std::vector<PressSamples>& presses) {
  constexpr double kApart = 2.0 * kStretch;
  law::Column at(s.f.cols());
  for (const PressSamples& press : presses)
    for (std::size_t k = press.from; k < press.to; ++k)
      at[static_cast<Eigen::Index>(k)] = static_cast<double>(k - press.from);
  std::vector<double> knots;
  for (double knot = 0; knot < at.maxCoeff() + kApart; knot += kApart) knots.push_back(knot);
  return law::hats(at, knots);
}

enum class Repeats { kUnknown, kAlike, kDifferent };

// What presses of one place the same way say of their gains.
Repeats compare_repeats(const std::vector<PressSamples>& presses) {
  constexpr double kWithin = 10 * M_PI / 180, kAlikeShare = 0.25, kLittle = 0.25;
  constexpr int kFewest = 4;
  const auto same = [&](const PressSamples& a, const PressSamples& b) {
    return a.place == b.place && a.way.dot(b.way) > std::cos(kWithin) * a.way.norm() * b.way.norm();
  };
  double within = 0, there = 0, loads_there = 0, all = 0, loads = 0;
  int freedom = 0;
  for (const PressSamples& press : presses) {
    all += press.load * press.gain.squaredNorm();
    loads += press.load;
    Vec3 mean = Vec3::Zero();
    int count = 0;
    for (const PressSamples& other : presses) {
      if (!same(press, other)) continue;
      mean += other.gain;
      ++count;
    }
    if (count < 2) continue;
    mean /= count;
    const double unbiased = static_cast<double>(count) / (count - 1);
    within += press.load * unbiased * (press.gain - mean).squaredNorm();
    there += press.load * press.gain.squaredNorm();
    loads_there += press.load;
    ++freedom;
  }
  if (freedom < 2 * kFewest || !(there * loads > kLittle * all * loads_there))
    return Repeats::kUnknown;
  return within < kAlikeShare * there ? Repeats::kAlike : Repeats::kDifferent;
}

}  // namespace

std::vector<LeftKind> own_laws(const LawSamples& s, const Eigen::VectorXd& residual,
                               const std::function<double(double)>& share) {
  const std::vector<PressSamples> presses = split_presses(s, residual);
  const auto foretold = [&](const Eigen::MatrixXd& columns) {
    return share(unforetold(columns, residual, presses));
  };
  const double by_gain = foretold(gain_columns(s)), by_any = foretold(law::stacked(loads(s), s));
  const double by_load = by_any > kAll ? std::max(by_gain, by_any) : by_gain;
  const double by_zero = foretold(zero_columns(s));
  if (by_zero > kNearlyAll && by_zero >= by_load) return {{kZeroOfPress, by_zero, true}};
  if (by_load > kNearlyAll) {
    const Repeats repeats = compare_repeats(presses);
    if (repeats == Repeats::kAlike) return {{kPlaceAndWay, by_load, true}};
    std::vector<LeftKind> kinds{{kPress, by_load, true}};
    if (repeats == Repeats::kUnknown) kinds.push_back({kPlaceAndWay, by_load, true});
    return kinds;
  }
  return {};
}

std::vector<LeftKind> wandering(const LawSamples& s, const Eigen::VectorXd& residual,
                                const std::function<double(double)>& share) {
  const std::vector<PressSamples> presses = split_presses(s, residual);
  double most = 0;
  for (const law::Columns& what : {law::zeros(s), law::gains(s)})
    most = std::max(most, share(unforetold(law::stacked(law::times(moments(s, presses), what), s),
                                           residual, presses)));
  return most > kMostly ? std::vector<LeftKind>{{kWander, most, true}} : std::vector<LeftKind>{};
}

}  // namespace hapsim
