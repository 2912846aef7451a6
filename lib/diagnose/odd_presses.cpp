#include "diagnose/odd_presses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/gates.h"
#include "diagnose/held_out.h"
#include "diagnose/left_over.h"

namespace hapsim {
namespace {

// By press, as many as the dataset has: root mean square of what the model leaves, over noise and
// allowance (`off`), and over the noise alone.
struct Errors {
  std::vector<double> off, over_noise;
};
Errors errors_of(const Fit& fitted, const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(fitted, g.experiment, all, false).f;
  const Eigen::VectorXd residual = measured_forces(g.dataset, all) - f;
  Errors errors;
  Eigen::Index at = 0;
  for (const Episode& e : g.dataset.episodes) {
    const auto size = 3 * static_cast<Eigen::Index>(e.rows.size());
    const double components = std::max<double>(1, static_cast<double>(size) * g.dataset.axes() / 3);
    const double error = residual.segment(at, size).norm() / std::sqrt(components);
    const double force = f.segment(at, size).norm() / std::sqrt(components);
    const double floor =
        g.dataset.floor_at(static_cast<std::size_t>(e.position), g.allowance.floor);
    errors.off.push_back(error / std::hypot(g.allowance.noise, floor * force));
    errors.over_noise.push_back(error / g.allowance.noise);
    at += size;
  }
  return errors;
}

// How the tool moved, wherever.
struct Course {
  double depth = 0;     // largest displacement [m]
  double slant = 0;     // of that displacement from the normal [rad]
  double reached = 0;   // when it was there [s]
  double duration = 0;  // [s]
};

Course course_of(const Episode& e) {
  Course c;
  for (std::size_t i = 0; i < e.view.size(); ++i) {
    if (e.view.u[i].norm() <= 1.001 * c.depth) continue;
    c.depth = e.view.u[i].norm();
    if (!e.view.t.empty()) c.reached = e.view.t[i];
  }
  c.slant = std::acos(std::clamp(-e.view.direction.dot(e.view.normal), -1.0, 1.0));
  if (!e.view.t.empty()) c.duration = e.view.t.back();
  return c;
}

// Of two lengths or times that count as one, the smaller over the other.
constexpr double kNear = 0.7;

// But for its times.
bool alike(const Course& a, const Course& b) {
  constexpr double kSlant = 0.3;  // [rad]
  return std::min(a.depth, b.depth) >= kNear * std::max(a.depth, b.depth) &&
         std::abs(a.slant - b.slant) < kSlant;
}

// How far the tool went in each direction (kDirections), in depth and sideways, and how fast: what
// a law may set in with.
constexpr std::size_t kDirections = 6;
std::vector<double> extents_of(const Episode& e) {
  std::vector<double> most(kDirections + 2, 0);
  for (const Vec3& u : e.view.u) {
    for (std::size_t k = 0; k < 3; ++k) {
      most[k] = std::max(most[k], u[static_cast<Eigen::Index>(k)]);
      most[kDirections / 2 + k] =
          std::max(most[kDirections / 2 + k], -u[static_cast<Eigen::Index>(k)]);
    }
    const double depth = -u.dot(e.view.normal);
    most[kDirections] = std::max(most[kDirections], depth);
    most[kDirections + 1] = std::max(most[kDirections + 1], (u + depth * e.view.normal).norm());
  }
  const Course c = course_of(e);
  most.push_back(c.reached > 0 ? c.depth / c.reached : 0);
  most.push_back(c.duration);
  return most;
}

// Whether all of them went further, in one of these ways, than all others: then that may be why.
// One press goes furthest in some direction by chance.
bool went_further(const std::vector<bool>& odd, const Dataset& dataset) {
  constexpr double kApart = 0.25;  // of the range, where only one did
  std::vector<std::vector<double>> extents;
  for (const Episode& e : dataset.episodes) extents.push_back(extents_of(e));
  const bool one = std::count(odd.begin(), odd.end(), true) == 1;
  for (std::size_t c = one ? kDirections : 0; c < extents.front().size(); ++c) {
    double least = std::numeric_limits<double>::infinity(), most = 0, range = 0;
    for (std::size_t k = 0; k < odd.size(); ++k) {
      range = std::max(range, extents[k][c]);
      if (odd[k]) least = std::min(least, extents[k][c]);
      if (!odd[k]) most = std::max(most, extents[k][c]);
    }
    if (least > most + (one ? kApart : 1e-6) * range) return true;
  }
  return false;
}

// What others of like depth and slant took, the least and the most.
struct Times {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  void take(double t) { least = std::min(least, t), most = std::max(most, t); }
  bool hold(double t) const { return kNear * least <= t && kNear * t <= most; }
};

// Whether neither its place nor its motion is why the press is odd. A law of time or speed that
// made it odd would make one of the slower or one of the faster ones odd as well.
bool spoken_against(std::size_t press, const std::vector<bool>& odd, const Dataset& dataset) {
  const Course course = course_of(dataset.episodes[press]);
  bool place = false;
  Times reached, duration;
  for (std::size_t k = 0; k < odd.size(); ++k) {
    if (odd[k]) continue;
    const Episode& other = dataset.episodes[k];
    place = place || other.position == dataset.episodes[press].position;
    const Course c = course_of(other);
    if (!alike(course, c)) continue;
    reached.take(c.reached);
    duration.take(c.duration);
  }
  return place && reached.hold(course.reached) && duration.hold(course.duration);
}

Experiment without(const std::vector<bool>& odd, const Experiment& e) {
  Experiment rest = e;
  rest.dataset.episodes.clear();
  for (std::size_t k = 0; k < odd.size(); ++k)
    if (!odd[k]) rest.dataset.episodes.push_back(e.dataset.episodes[k]);
  return rest;
}

// The model fitted to the presses that are not odd, and what it leaves of them.
struct Rest {
  Fit fitted;
  LeftOver left;
};
Rest rest_of(const Fit& fitted, const std::vector<bool>& odd, const TrialGround& g) {
  const Experiment e = without(odd, g.experiment);
  const TrialGround ground(e, g.allowance);
  Fit anew =
      fit(fitted.model, e, all_episodes(e.dataset), trial_fit_options(ground, 0), fitted.about);
  LeftOver left = left_over(anew, ground);
  return {std::move(anew), std::move(left)};
}

// Presses set aside, and how all err beside the model of the others.
struct Aside {
  std::vector<bool> odd;  // empty: there are none to set aside
  Rest rest;
  Errors errors;
  bool noise_alone() const { return rest.left.noise_alone() && rest.left.error < kAlike; }
};

Aside without_them(const Fit& fitted, const std::vector<bool>& odd, const TrialGround& g) {
  Aside aside;
  aside.rest = rest_of(fitted, odd, g);
  if (!aside.rest.fitted.converged) return {};
  aside.odd = odd;
  aside.errors = errors_of(aside.rest.fitted, g);
  return aside;
}

// The worst, and those that err nearly as much, until the others leave noise alone.
Aside set_aside(const Fit& fitted, const TrialGround& g) {
  constexpr double kNearWorst = 0.8;
  constexpr int kMostRounds = 12;
  const std::size_t count = g.dataset.episodes.size();
  std::vector<bool> odd(count, false);
  Errors errors = errors_of(fitted, g);
  for (int round = 0; round < kMostRounds; ++round) {
    double worst = OddPresses::kOdd / kNearWorst;
    for (std::size_t k = 0; k < count; ++k)
      if (!odd[k]) worst = std::max(worst, errors.off[k]);
    const std::vector<bool> before = odd;
    for (std::size_t k = 0; k < count; ++k) odd[k] = odd[k] || errors.off[k] >= kNearWorst * worst;
    const auto many = static_cast<std::size_t>(std::count(odd.begin(), odd.end(), true));
    if (odd == before || 4 * many > count || count - many < kLeastPresses) return {};
    Aside aside = without_them(fitted, odd, g);
    if (aside.odd.empty() || aside.noise_alone()) return aside;
    errors = std::move(aside.errors);
  }
  return {};
}

// Those that are as the others' model says come back.
Aside come_back(const Aside& aside, const Fit& fitted, const TrialGround& g) {
  std::vector<bool> odd = aside.odd;
  for (std::size_t k = 0; k < odd.size(); ++k)
    odd[k] = odd[k] && aside.errors.off[k] >= OddPresses::kOdd;
  if (odd == aside.odd) return aside;
  Aside fewer = without_them(fitted, odd, g);
  return fewer.noise_alone() ? fewer : Aside{};
}

}  // namespace

std::string OddPresses::words() const {
  const bool one = ids.size() == 1;
  return fmt::format(
      "{0} {1} {2} unlike all others, up to {3:.2g} x the noise off, though other presses at the "
      "same {4} and like ones elsewhere are as the model says; without {5} {6:.2g} x the noise is "
      "left: look at what happened there, or leave {5} out and diagnose again.",
      one ? "Press" : "Presses", fmt::join(ids, ", "), one ? "is" : "are", off,
      one ? "place" : "places", one ? "it" : "them", beside);
}

OddPresses find_odd_presses(const Fit& fitted, const TrialGround& g) {
  const Aside aside = come_back(set_aside(fitted, g), fitted, g);
  if (aside.odd.empty() || went_further(aside.odd, g.dataset)) return {};
  OddPresses found;
  found.beside = aside.rest.left.error;
  for (std::size_t k = 0; k < aside.odd.size(); ++k) {
    if (!aside.odd[k]) continue;
    if (!spoken_against(k, aside.odd, g.dataset)) return {};
    const Episode& e = g.dataset.episodes[k];
    found.ids.push_back(g.dataset.recording.press[static_cast<std::size_t>(e.rows.front())]);
    found.off = std::max(found.off, aside.errors.over_noise[k]);
  }
  return found;
}

}  // namespace hapsim
