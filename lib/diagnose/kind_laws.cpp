#include "diagnose/kind_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "compare/breakdown.h"
#include "diagnose/left_over.h"
#include "diagnose/shared_law.h"

namespace hapsim {
namespace {

constexpr std::size_t kMany = 10000;  // samples
constexpr double kTurn = 0.01;        // of the longest way, within which an axis turns

using Column = LawSamples::Column;
using Vectors = LawSamples::Vectors;
using Columns = std::vector<Vectors>;

Vectors slope(const Vectors& v, const std::vector<double>& t) {
  Vectors d = Vectors::Zero(3, v.cols());
  const auto last = v.cols() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index a = std::max<Eigen::Index>(0, i - 1), b = std::min(last, i + 1);
    const double dt = t[static_cast<std::size_t>(b)] - t[static_cast<std::size_t>(a)];
    if (dt > 0) d.col(i) = (v.col(b) - v.col(a)) / dt;
  }
  return d;
}

std::vector<double> quantiles(const Column& x, int count) {
  std::vector<double> sorted(x.begin(), x.end()), knots;
  std::sort(sorted.begin(), sorted.end());
  for (int k = 0; k < count; ++k) {
    const double at = sorted[(sorted.size() - 1) * static_cast<std::size_t>(k) /
                             static_cast<std::size_t>(count - 1)];
    if (knots.empty() || at > knots.back()) knots.push_back(at);
  }
  return knots;
}

std::vector<double> even(const Column& x, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k)
    knots.push_back(x.minCoeff() + (x.maxCoeff() - x.minCoeff()) * k / (count - 1));
  return knots;
}

// Piecewise linear, one at its knot and zero at the others.
std::vector<Column> hats(const Column& x, const std::vector<double>& knots) {
  std::vector<Column> hat(knots.size(), Column::Zero(x.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto above = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), x[i]) -
                                                knots.begin());
    if (above == 0 || above == knots.size()) {
      hat[above == 0 ? 0 : above - 1][i] = 1;
      continue;
    }
    const double share = (x[i] - knots[above - 1]) / (knots[above] - knots[above - 1]);
    hat[above - 1][i] = 1 - share;
    hat[above][i] = share;
  }
  return hat;
}

// What a law may do that acts alike on all samples: gains along the normal and across it, those of
// each axis, a zero of each axis and along the normal.
Columns gains(const LawSamples& s) {
  return {s.along, s.across};
}
Columns gains_of_axes(const LawSamples& s) {
  Columns c(3, Vectors::Zero(3, s.f.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis) = s.f.row(axis);
  return c;
}
Columns zeros(const LawSamples& s) {
  Columns c(3, Vectors::Zero(3, s.f.cols()));
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    c[static_cast<std::size_t>(axis)].row(axis).setOnes();
  c.push_back(s.normal);
  return c;
}

Columns join(Columns a, const Columns& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Columns times(const std::vector<Column>& factors, const Columns& what) {
  Columns c;
  for (const Column& factor : factors)
    for (const Vectors& v : what) c.emplace_back(v * factor.asDiagonal());
  return c;
}

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

std::vector<Column> numbers(const LawSamples& s) {
  const double most = std::min(5.0, s.number.maxCoeff());
  std::vector<Column> found;
  for (double number = 0; number <= most; ++number)
    found.push_back(
        s.number.unaryExpr([&](double x) { return std::min(x, most) == number ? 1.0 : 0.0; }));
  return found;
}

// How far the force leans from the normal: its sine.
Column slants(const LawSamples& s) {
  return s.across.colwise().norm().array() /
         (s.f.colwise().norm().array() + std::numeric_limits<double>::min());
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

Columns by_matrix(const LawSamples& s) {
  Columns c;
  for (Eigen::Index to = 0; to < 3; ++to)
    for (Eigen::Index from = 0; from < 3; ++from) {
      c.emplace_back(Vectors::Zero(3, s.f.cols()));
      c.back().row(to) = s.f.row(from);
    }
  return c;
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

// Of some recordings a law has no columns.
Eigen::MatrixXd stacked(const Columns& columns, const LawSamples& s) {
  Eigen::MatrixXd X(s.f.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    X.col(static_cast<Eigen::Index>(k)) = columns[k].reshaped();
  return X;
}

}  // namespace

Eigen::MatrixXd gain_columns(const LawSamples& s) {
  return stacked(gains(s), s);
}
Eigen::MatrixXd zero_columns(const LawSamples& s) {
  return stacked(zeros(s), s);
}

LawSamples law_samples(const Eigen::VectorXd& forces, const Dataset& dataset) {
  const std::size_t stride = 1 + static_cast<std::size_t>(forces.size()) / 3 / kMany;
  const Eigen::Index all = forces.size() / 3;
  const Eigen::Index count =
      (all + static_cast<Eigen::Index>(stride) - 1) / static_cast<Eigen::Index>(stride);
  LawSamples s;
  s.timed = s.warmed = true;
  for (Column* c :
       {&s.depth, &s.speed, &s.fastest, &s.growth, &s.age, &s.session, &s.number, &s.temperature})
    *c = Column::Zero(count);
  for (Vectors* v :
       {&s.f, &s.along, &s.across, &s.normal, &s.u, &s.velocity, &s.acceleration, &s.way, &s.rate})
    *v = Vectors::Zero(3, count);
  double longest = 0;
  for (const Vec3& u : dataset.recording.u) longest = std::max(longest, u.norm());
  std::map<int, int> pressed;
  Eigen::Index at = 0;
  int press = -1;
  for (const Episode& e : dataset.episodes) {
    ++press;
    const auto n = static_cast<Eigen::Index>(e.rows.size());
    const Vectors f = forces.segment(3 * at, 3 * n).reshaped(3, n);
    Vectors u(3, n);
    for (Eigen::Index i = 0; i < n; ++i)
      u.col(i) = dataset.recording.u[static_cast<std::size_t>(e.rows[static_cast<std::size_t>(i)])];
    s.timed = s.timed && !e.view.session.empty();
    s.warmed = s.warmed && !e.view.temperature.empty();
    const Vectors v = s.timed ? slope(u, e.view.t) : Vectors::Zero(3, n);
    const Vectors a = s.timed ? slope(v, e.view.t) : Vectors::Zero(3, n);
    const Vectors df = s.timed ? slope(f, e.view.t) : Vectors::Zero(3, n);
    const int number = pressed[e.position]++;
    double fastest = 0;
    Vec3 way = Vec3::Zero();
    for (Eigen::Index i = 0; i < n; ++i) {
      fastest = std::max(fastest, v.col(i).norm());
      if (i > 0)
        way = (way + (u.col(i) - u.col(i - 1)) / (kTurn * longest)).cwiseMax(-1).cwiseMin(1);
      if ((at + i) % static_cast<Eigen::Index>(stride) != 0) continue;
      const auto k = static_cast<Eigen::Index>(s.kept.size());
      s.kept.push_back(at + i);
      s.since.push_back(i);
      s.press.push_back(press);
      s.depth[k] = u.col(i).norm();
      s.speed[k] = v.col(i).norm();
      s.fastest[k] = fastest;
      s.growth[k] = s.depth[k] > 0 ? v.col(i).dot(u.col(i)) / s.depth[k] : s.speed[k];
      s.number[k] = number;
      if (s.warmed) s.temperature[k] = e.view.temperature[static_cast<std::size_t>(i)];
      if (s.timed) {
        s.age[k] = e.view.t[static_cast<std::size_t>(i)];
        s.session[k] = e.view.session[static_cast<std::size_t>(i)];
      }
      s.f.col(k) = f.col(i);
      s.along.col(k) = f.col(i).dot(e.view.normal) * e.view.normal;
      s.across.col(k) = s.f.col(k) - s.along.col(k);
      s.normal.col(k) = e.view.normal;
      s.u.col(k) = u.col(i);
      s.velocity.col(k) = v.col(i);
      s.acceleration.col(k) = a.col(i);
      s.way.col(k) = way;
      s.rate.col(k) = df.col(i);
    }
    at += n;
  }
  return s;
}

std::vector<KindLaw> kind_laws(const LawSamples& s, const Eigen::VectorXd& forces,
                               const Dataset& dataset) {
  std::vector<KindLaw> laws;
  const auto law = [&](const char* kind, std::function<Columns()> columns) {
    laws.push_back({kind, [&s, columns] { return stacked(columns(), s); }});
  };
  // Gains and zeros by a variable.
  const auto laws_by = [&](const char* kind, const char* of_zero, std::vector<Column> variable) {
    law(kind, [&s, variable] { return times(variable, gains(s)); });
    law(of_zero, [&s, variable] { return times(variable, zeros(s)); });
  };
  law("offset", [&] { return zeros(s); });
  laws_by("cycle", "cycle", numbers(s));
  law(kSetUp, [&] { return by_matrix(s); });
  for (const int knots : {7, 20})
    laws_by("depth", "depth", hats(s.depth, quantiles(s.depth, knots)));
  law("depth", [&] { return by_travel(s); });
  laws_by("phase", "phase", phases(s));
  law("phase", [&] { return by_way(s); });
  if (s.warmed)
    laws_by(kByTemperature, kByTemperature, hats(s.temperature, quantiles(s.temperature, 4)));
  if (s.timed) {
    const std::vector<Column> session = hats(s.session, even(s.session, 9));
    laws_by("session-time", "drift", session);
    law("session-time", [&s, session] { return times(session, gains_of_axes(s)); });
    laws_by("contact-time", "contact-time", hats(s.age, quantiles(s.age, 6)));
    law("rate", [&] { return by_rate(s); });
  }
  law(kDirection, [&] { return times(hats(slants(s), quantiles(slants(s), 4)), gains(s)); });
  laws.push_back({kDirection, [&] {
                    return Eigen::MatrixXd(
                        law_columns(forces, dataset)(stacked_components(s), Eigen::all));
                  }});
  law("history", [&] { return by_history(s, forces, dataset); });
  law("reading", [&] { return by_reading(s); });
  return laws;
}

std::vector<Eigen::Index> stacked_components(const LawSamples& s) {
  std::vector<Eigen::Index> rows;
  for (const Eigen::Index sample : s.kept)
    for (Eigen::Index c = 0; c < 3; ++c) rows.push_back(3 * sample + c);
  return rows;
}

}  // namespace hapsim
