#include "diagnose/kind_laws.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "compare/breakdown.h"
#include "diagnose/law_columns.h"
#include "diagnose/left_over.h"
#include "diagnose/order_laws.h"
#include "diagnose/shared_law.h"

namespace hapsim {
namespace law {
namespace {

Columns by_rate(const LawSamples& s) {
  const Column over = s.speed.unaryExpr([](double v) { return v > 0 ? 1 / v : 0.0; });
  // What the motion meets, of any law of the speed, and the tool's own mass.
  const Vectors against = s.velocity * over.asDiagonal();
  const Columns c{s.velocity, Vectors(s.velocity * s.speed.asDiagonal()), s.acceleration};
  const std::vector<Column> speeds = hats(s.speed, quantiles(s.speed, 6));
  return join(join(c, times(speeds, {s.f, s.rate, against})),
              times(hats(s.fastest, quantiles(s.fastest, 4)), {s.f}));
}

// Depths while it loads, holds and unloads.
std::vector<Column> phases(const LawSamples& s) {
  constexpr double kHold = 0.05;  // of the fastest motion
  std::vector<Column> found;
  const double hold = kHold * s.growth.cwiseAbs().maxCoeff();
  for (const int sign : {-1, 0, 1}) {
    const Column in = s.growth.unaryExpr([&](double v) {
      return (v > hold ? 1 : v < -hold ? -1 : 0) == sign ? 1.0 : 0.0;
    });
    for (const Column& d : hats(s.depth, quantiles(s.depth, 4)))
      found.push_back(d.cwiseProduct(in));
  }
  return found;
}

// Dry friction of each axis, which holds while nothing moves.
Columns by_way(const LawSamples& s) {
  Columns c(3, Vectors::Zero(3, s.way.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis) = s.way.row(axis);
  return c;
}

// Which way the force leans, about the normal, in eighths of a turn: hat functions.
std::vector<Column> azimuths(const LawSamples& s) {
  constexpr int kEighths = 8;
  std::vector<Column> found(kEighths, Column::Zero(s.f.cols()));
  for (Eigen::Index i = 0; i < s.f.cols(); ++i) {
    const Vec3 n = s.normal.col(i), v = s.across.col(i);
    // A way across all normals that are not along x; of these any does.
    Vec3 e = Vec3::UnitX() - n.x() * n;
    e = e.norm() > 0 ? e.normalized() : n.unitOrthogonal();
    if (!(v.norm() > 0)) continue;
    const double turn = (std::atan2(v.dot(n.cross(e)), v.dot(e)) / (2 * M_PI) + 1) * kEighths;
    const int at = static_cast<int>(turn);
    found[static_cast<std::size_t>(at % kEighths)][i] = 1 - (turn - at);
    found[static_cast<std::size_t>((at + 1) % kEighths)][i] = turn - at;
  }
  return found;
}

// What a tool that is pushed sideways meets, by how far: along its way and across it, of the load
// and of the force.
Columns by_side(const LawSamples& s) {
  constexpr int kSteps = 10;
  const Eigen::Index count = s.f.cols();
  Column far(count);
  Vectors way(3, count), turned_way(3, count), turned(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 n = s.normal.col(i), u = s.u.col(i), across = s.across.col(i);
    const Vec3 side = u - n.dot(u) * n;
    far[i] = side.norm();
    way.col(i) = far[i] > 0 ? Vec3(s.along.col(i).norm() / far[i] * side) : Vec3(Vec3::Zero());
    turned_way.col(i) = n.cross(Vec3(way.col(i)));
    turned.col(i) = n.cross(across);
  }
  return times(hats(far, even(far, kSteps)), {way, turned_way, s.across, turned});
}

// Zeros by how far each axis has moved.
Columns by_travel(const LawSamples& s) {
  constexpr int kSteps = 16;
  Columns c;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Column moved = s.u.row(axis);
    if (moved.maxCoeff() > moved.minCoeff())
      c = join(c, times(hats(moved, even(moved, kSteps)), zeros(s)));
  }
  return c;
}

Columns by_reading(const LawSamples& s) {
  constexpr int kSteps = 40;
  constexpr Eigen::Index kFewest = 20;  // samples of a step
  Columns c;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Column own = s.f.row(axis);
    const double low = own.minCoeff(), width = (own.maxCoeff() - low) / kSteps;
    if (!(width > 0)) continue;
    const Eigen::VectorXi step = ((own.array() - low) / width).cast<int>().min(kSteps - 1);
    for (int k = 0; k < kSteps; ++k) {
      if ((step.array() == k).count() < kFewest) continue;
      c.emplace_back(Vectors::Zero(3, own.size()));
      c.back().row(axis) = (step.array() == k).cast<double>().transpose();
    }
  }
  return c;
}

// Gains along the normal and across it, and a turn about it.
Columns about_normal(const LawSamples& s) {
  Vectors turned(3, s.f.cols());
  for (Eigen::Index i = 0; i < s.f.cols(); ++i)
    turned.col(i) = Vec3(s.normal.col(i)).cross(Vec3(s.across.col(i)));
  return join(gains(s), {turned});
}

// One, and how far the place lies along the two longest axes of all places, from -1 to 1.
std::vector<Column> slopes(const LawSamples& s) {
  const Vectors off = s.place.colwise() - s.place.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(off * off.transpose());
  std::vector<Column> found{Column::Ones(s.f.cols())};
  for (const int axis : {2, 1}) {
    const Column x = off.transpose() * axes.eigenvectors().col(axis);
    const double half = (x.maxCoeff() - x.minCoeff()) / 2;
    if (half > 0) found.emplace_back((x.array() - x.minCoeff()) / half - 1);
  }
  return found;
}

// The same, and what curves over the places.
std::vector<Column> curved(const LawSamples& s) {
  std::vector<Column> found = slopes(s);
  const std::size_t straight = found.size();
  for (std::size_t a = 1; a < straight; ++a)
    for (std::size_t b = a; b < straight; ++b) found.emplace_back(found[a].cwiseProduct(found[b]));
  return found;
}

// The increment of the force between two lags, along the normal and across it; before the press
// there is none.
Columns by_history(const LawSamples& s, const Eigen::VectorXd& forces, const Dataset& dataset) {
  std::size_t longest = 0;
  for (const Episode& e : dataset.episodes) longest = std::max(longest, e.rows.size());
  std::vector<Eigen::Index> lags{0};
  while (lags.back() < static_cast<Eigen::Index>(longest))
    lags.push_back(std::max(lags.back() + 1, lags.back() * 4 / 3));
  Columns c;
  const auto force = [&](std::size_t k, Eigen::Index lag) -> Vec3 {
    return forces.segment<3>(3 * (s.kept[k] - std::min(lag, s.since[k])));
  };
  for (std::size_t b = 0; b + 1 < lags.size(); ++b) {
    Vectors along(3, s.f.cols()), across(3, s.f.cols());
    for (std::size_t k = 0; k < s.kept.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const Vec3 d = force(k, lags[b]) - force(k, lags[b + 1]);
      const double size = s.along.col(i).norm();
      const Vec3 n = size > 0 ? Vec3(s.along.col(i) / size) : Vec3(Vec3::Zero());
      along.col(i) = d.dot(n) * n;
      across.col(i) = d - along.col(i);
    }
    c.push_back(along);
    c.push_back(across);
  }
  return c;
}

}  // namespace
}  // namespace law

Eigen::MatrixXd gain_columns(const LawSamples& s) {
  return law::stacked(law::gains(s), s);
}
Eigen::MatrixXd zero_columns(const LawSamples& s) {
  return law::stacked(law::zeros(s), s);
}

std::vector<KindLaw> kind_laws(const LawSamples& s, const Eigen::VectorXd& forces,
                               const Dataset& dataset) {
  using namespace law;
  std::vector<KindLaw> laws;
  const auto add = [&](const char* kind, const std::function<Columns()>& columns,
                       const std::function<Columns()>& without = {}) {
    laws.push_back({kind, [&s, columns] { return stacked(columns(), s); }});
    if (without) laws.back().without = [&s, without] { return stacked(without(), s); };
  };
  // Gains and zeros by a variable.
  const auto laws_by = [&](const char* kind, const char* of_zero, std::vector<Column> variable) {
    add(kind, [&s, variable] { return times(variable, gains(s)); });
    add(of_zero, [&s, variable] { return times(variable, zeros(s)); });
  };
  add("offset", [&] { return zeros(s); });
  add(kSetUp, [&] { return by_matrix(s); });
  add(kSetUp, [&] { return by_motion(s); });
  for (const int knots : {7, 20})
    laws_by("depth", "depth", hats(s.depth, quantiles(s.depth, knots)));
  add("depth", [&] { return by_travel(s); });
  const std::vector<std::pair<std::vector<Column>, int>> of_phase{
      {phases(s), 4}, {hats(s.deepest, quantiles(s.deepest, 8)), 8}};
  for (const auto& [variable, knots] : of_phase)
    for (const Columns& what : {gains(s), zeros(s)})
      add(
          "phase", [=] { return times(variable, what); },
          [=, &s] { return times(hats(s.depth, quantiles(s.depth, knots)), what); });
  add("phase", [&] { return by_way(s); });
  if (s.warmed)
    laws_by(kByTemperature, kByTemperature, hats(s.temperature, quantiles(s.temperature, 4)));
  if (s.timed) {
    const std::vector<Column> session = hats(s.session, even(s.session, 9));
    laws_by("session-time", "drift", session);
    add("session-time", [&s, session] { return times(session, gains_of_axes(s)); });
    laws_by("contact-time", "contact-time", hats(s.age, quantiles(s.age, 6)));
    add("rate", [&] { return by_rate(s); });
  }
  add(kDirection, [&] { return times(hats(slants(s), quantiles(slants(s), 4)), gains(s)); });
  laws.push_back({kDirection, [&] {
                    return Eigen::MatrixXd(
                        law_columns(forces, dataset)(stacked_components(s), Eigen::all));
                  }});
  add(kDirection, [&] { return times(azimuths(s), {s.across}); });
  add(kDirection, [&] { return by_side(s); });
  for (const Columns& what : {by_matrix(s), about_normal(s)})
    add(
        kBody, [&s, what] { return times(slopes(s), what); }, [what] { return what; });
  const std::vector<Column> deep = hats(s.depth, quantiles(s.depth, 4));
  add(
      kBody, [&s, deep] { return times(products(curved(s), deep), gains(s)); },
      [&s, deep] { return times(deep, gains(s)); });
  add("history", [&] { return by_history(s, forces, dataset); });
  add("reading", [&] { return by_reading(s); });
  add_order_laws(s, laws);
  return laws;
}

}  // namespace hapsim
