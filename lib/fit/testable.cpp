#include "fit/testable.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "effects/catalogue.h"
#include "fit/learned_field.h"
#include "recording/ceiling.h"

namespace hapsim {
namespace {

constexpr double kLeastWarming = 0.5;  // [K]
constexpr double kSideways = 0.2;      // of the depth
constexpr double kReturn = 0.8;        // of the deepest displacement
constexpr double kOwnTime = 0.1;       // of the time's spread, that depth does not tell

// Between the coldest and the warmest press, so that a thermometer's noise does not count.
double temperature_range(const Dataset& dataset) {
  double low = 1e300, high = -1e300;
  for (const Episode& e : dataset.episodes) {
    const std::vector<double>& t = e.view.temperature;
    const double mean = std::accumulate(t.begin(), t.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(1, t.size()));
    low = std::min(low, mean);
    high = std::max(high, mean);
  }
  return high - low;
}

bool begins_anew(const Dataset& dataset) {
  for (std::size_t e = 1; e < dataset.episodes.size(); ++e)
    if (dataset.episodes[e].view.session.front() < dataset.episodes[e - 1].view.session.back())
      return true;
  return false;
}

// Presses whose first samples tell as much as a way out.
constexpr std::size_t kLeastStarts = 6;

// Whether the depth tells the time: all presses go one steady way in, without a hold, a return or
// another pace. A cubic stands for steady ones of any kind. Of a body it is the time since it was
// touched; of a sensor that of the session, in the air as well.
bool depth_is_time(const Dataset& dataset, bool of_sensor) {
  std::vector<Eigen::Vector2d> points;
  double deepest = 0;
  for (const Episode& e : dataset.episodes) {
    const PressView& view = e.view;
    const std::vector<double>& time = of_sensor && !view.session.empty() ? view.session : view.t;
    double begin = of_sensor ? 0 : -1;
    for (std::size_t i = 0; i < view.size(); ++i) {
      if (view.in_air[i] && !of_sensor) continue;
      if (begin < 0) begin = time[i];
      points.emplace_back(view.in_air[i] ? 0 : view.u[i].dot(view.direction), time[i] - begin);
      deepest = std::max(deepest, points.back()[0]);
    }
  }
  if (points.size() < 8 || deepest <= 0) return false;
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(n, 4);
  Eigen::VectorXd t(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = points[static_cast<std::size_t>(i)][0] / deepest;
    powers.row(i) << 1, x, x * x, x * x * x;
    t[i] = points[static_cast<std::size_t>(i)][1];
  }
  const Eigen::VectorXd left = t - powers * powers.colPivHouseholderQr().solve(t);
  return left.norm() < kOwnTime * (t.array() - t.mean()).matrix().norm();
}

}  // namespace

bool moves_sideways(const PressView& view) {
  double along = 0, across = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (view.in_air[i]) continue;
    along = std::max(along, -view.u[i].dot(view.normal));
    across = std::max(across, (view.u[i] - view.u[i].dot(view.normal) * view.normal).norm());
  }
  return across > kSideways * along;
}

bool comes_back(const PressView& view) {
  constexpr double kIn = 0.1;  // of the largest depth
  double most = 0, deepest = 0;
  for (const Vec3& u : view.u) most = std::max(most, u.dot(view.direction));
  for (const Vec3& u : view.u) {
    const double depth = u.dot(view.direction);
    if (deepest > kIn * most && depth < kReturn * deepest) return true;
    deepest = std::max(deepest, depth);
  }
  return false;
}

std::string not_shared(const EffectCard& effect, const Dataset& dataset) {
  if (effect.one_body && dataset.bodies() > 1)
    return "its parameters belong to one body, and there are several: fit each body by itself";
  if (effect.one_tool && dataset.tools() > 1)
    return "its parameters belong to one tool, and there are several: fit each tool by itself";
  return "";
}

void require_shared(const std::vector<std::string>& effects, const Dataset& dataset) {
  for (const std::string& name : effects)
    if (const std::string why = not_shared(require_effect(name).card(), dataset); !why.empty())
      fail_usage(name + " cannot be shared", why);
}

std::string lacking_for(const EffectCard& effect, const Dataset& dataset) {
  if (std::string why = not_shared(effect, dataset); !why.empty()) return why;
  if (effect.needs_time && dataset.recording.t.empty())
    return "the recording has no column t: record the time of every sample";
  if (effect.needs_time) {
    double longest = 0;
    for (const Episode& e : dataset.episodes) longest = std::max(longest, e.view.t.back());
    if (longest <= 0) return "all samples have the same time: record the time of every sample";
  }
  const bool of_sensor = effect.stage == Stage::kSensor;
  if (effect.needs_time && (effect.learned ? !effect.needs_session : of_sensor) &&
      depth_is_time(dataset, of_sensor))
    return "the presses go in at one steady pace, where time and depth tell the same: press at "
           "another pace as well, or hold";
  if (effect.needs_session && begins_anew(dataset))
    return "the time begins anew with a press: record one clock that runs through all of them";
  if (effect.needs_positions && dataset.positions.size() < 4)
    return "too few contact positions: press at four places or more";
  if (effect.is_field && dataset.positions.size() < kLeastPlaces)
    return fmt::format(
        "too few contact positions to learn a field from: press at {} places or more",
        kLeastPlaces);
  if (effect.needs_rim && std::all_of(dataset.episodes.begin(), dataset.episodes.end(),
                                      [](const Episode& e) { return e.view.height > 0; }))
    return "the tool covers the whole body: press with a tool that covers a part of it";
  if (effect.needs_flat && dataset.recording.has_ball())
    return "the contact of a ball is its curvature's (tip): press with a flat tool";
  if (effect.needs_temperature) {
    if (dataset.recording.temp.empty())
      return "the recording has no column temp: record the body's temperature";
    if (temperature_range(dataset) < kLeastWarming)
      return fmt::format("the temperature changes by {:.2g} K only: press the body warm and cold",
                         temperature_range(dataset));
  }
  if (effect.needs_ceiling && ceiling_words(find_ceilings(dataset.recording.f)).empty())
    return fmt::format(
        "no axis has {} readings that are exactly its largest, so the sensor's end was not "
        "reached: it would show in presses of larger forces",
        kLeastAtCeiling);
  const auto some = [&](auto&& condition) {
    return std::any_of(dataset.episodes.begin(), dataset.episodes.end(),
                       [&](const Episode& e) { return condition(e.view); });
  };
  if (effect.needs_sideways && !some(moves_sideways))
    return "no press moves sideways: move the tool along the surface while it presses";
  if (effect.needs_return && !some(comes_back))
    return "no press is recorded on its way out: record until the tool has left";
  if (effect.shows_at_starts && dataset.episodes.size() < kLeastStarts && !some(comes_back))
    return fmt::format(
        "no press is recorded on its way out, and {} begin: record until the tool has left, or {} "
        "presses",
        dataset.episodes.size(), kLeastStarts);
  if (effect.needs_repeats && !some([](const PressView& v) {
        return v.past_depth > 0 || (!v.session.empty() && v.session.front() > 0);
      }))
    return "each place is pressed only once, or healed in between, and no press comes later than "
           "another by its time: press one place three times";
  return "";
}

}  // namespace hapsim
