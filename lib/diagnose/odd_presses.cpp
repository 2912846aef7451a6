#include "diagnose/odd_presses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
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

bool alike(const Course& a, const Course& b) {
  constexpr double kSlant = 0.3;  // [rad]
  const auto near = [](double x, double y) { return std::abs(x - y) <= 0.3 * std::max(x, y); };
  return near(a.depth, b.depth) && near(a.reached, b.reached) && near(a.duration, b.duration) &&
         std::abs(a.slant - b.slant) < kSlant;
}

// Whether neither its place nor its motion is why the press is odd.
bool spoken_against(std::size_t press, const std::vector<bool>& odd, const Dataset& dataset) {
  const Course course = course_of(dataset.episodes[press]);
  bool place = false, motion = false;
  for (std::size_t k = 0; k < odd.size(); ++k) {
    if (odd[k]) continue;
    const Episode& other = dataset.episodes[k];
    place = place || other.position == dataset.episodes[press].position;
    motion = motion || alike(course, course_of(other));
  }
  return place && motion;
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
  std::vector<bool> odd;
  Rest rest;
  Errors errors;
  bool noise_alone() const { return rest.left.noise_alone() && rest.left.error < kAlike; }
};

std::optional<Aside> without_them(const Fit& fitted, const std::vector<bool>& odd,
                                  const TrialGround& g) {
  Aside aside{odd, rest_of(fitted, odd, g), {}};
  if (!aside.rest.fitted.converged) return std::nullopt;
  aside.errors = errors_of(aside.rest.fitted, g);
  return aside;
}

// The worst, and those that err nearly as much, until the others leave noise alone.
std::optional<Aside> set_aside(const Fit& fitted, const TrialGround& g) {
  constexpr double kNearWorst = 0.8;
  constexpr int kMostRounds = 12;
  const std::size_t count = g.dataset.episodes.size();
  Aside aside{std::vector<bool>(count, false), {}, errors_of(fitted, g)};
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<bool> odd = aside.odd;
    double worst = OddPresses::kOdd / kNearWorst;
    for (std::size_t k = 0; k < count; ++k)
      if (!odd[k]) worst = std::max(worst, aside.errors.off[k]);
    for (std::size_t k = 0; k < count; ++k)
      odd[k] = odd[k] || aside.errors.off[k] >= kNearWorst * worst;
    const auto many = static_cast<std::size_t>(std::count(odd.begin(), odd.end(), true));
    if (odd == aside.odd || 4 * many > count || count - many < kLeastPresses) return std::nullopt;
    std::optional<Aside> next = without_them(fitted, odd, g);
    if (!next) return std::nullopt;
    if (next->noise_alone()) return next;
    aside = std::move(*next);
  }
  return std::nullopt;
}

// Those that are as the others' model says come back.
std::optional<Aside> come_back(const Aside& aside, const Fit& fitted, const TrialGround& g) {
  std::vector<bool> odd = aside.odd;
  for (std::size_t k = 0; k < odd.size(); ++k)
    odd[k] = odd[k] && aside.errors.off[k] >= OddPresses::kOdd;
  if (odd == aside.odd) return aside;
  std::optional<Aside> fewer = without_them(fitted, odd, g);
  return fewer && fewer->noise_alone() ? fewer : std::nullopt;
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
  std::optional<Aside> aside = set_aside(fitted, g);
  if (aside) aside = come_back(*aside, fitted, g);
  if (!aside) return {};
  OddPresses found;
  found.beside = aside->rest.left.error;
  for (std::size_t k = 0; k < aside->odd.size(); ++k) {
    if (!aside->odd[k]) continue;
    if (!spoken_against(k, aside->odd, g.dataset)) return {};
    const Episode& e = g.dataset.episodes[k];
    found.ids.push_back(g.dataset.recording.press[static_cast<std::size_t>(e.rows.front())]);
    found.off = std::max(found.off, aside->errors.over_noise[k]);
  }
  return found;
}

}  // namespace hapsim
