#include "experiment/fitted_range.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::size_t kMostRangePlaces = 64;
constexpr double kNextShare = 0.9;  // of the places have another one as near as `reach`
constexpr double kLeastReach = 2;   // tool radii: so far from a press the same material is felt
constexpr double kPerMetre = 1e5;   // of places and reach so many steps are written

double to_next(const std::vector<Vec3>& places, std::size_t p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t q = 0; q < places.size(); ++q)
    if (q != p) least = std::min(least, (places[q] - places[p]).squaredNorm());
  return std::sqrt(least);
}

// Each as far as can be from those before; `covers`: how far another is from the nearest of them.
std::vector<Vec3> apart(const std::vector<Vec3>& places, double& covers) {
  std::vector<double> far(places.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3> chosen;
  for (std::size_t next = 0; chosen.size() < std::min(kMostRangePlaces, places.size());) {
    chosen.push_back(places[next]);
    for (std::size_t p = 0; p < places.size(); ++p)
      far[p] = std::min(far[p], (places[p] - places[next]).norm());
    next = static_cast<std::size_t>(std::max_element(far.begin(), far.end()) - far.begin());
  }
  covers = *std::max_element(far.begin(), far.end());
  return chosen;
}

double fastest(const Dataset& dataset) {
  double most = 0;
  ToolSpeed speed;
  for (const Episode& e : dataset.episodes) {
    int press = 0;
    for (std::size_t i = 0; i < e.rows.size(); ++i) {
      const int now = dataset.recording.press[static_cast<std::size_t>(e.rows[i])];
      if (i == 0 || now != press || e.view.in_air[i]) speed.restart();
      press = now;
      if (!e.view.in_air[i]) most = std::max(most, speed.add(e.view.t[i], e.view.u[i]));
    }
  }
  return most;
}

double number_or_infinity(const Metadata& metadata, const std::string& name, const char* key) {
  const double value = metadata.number(key, name).value_or(std::numeric_limits<double>::infinity());
  if (value < 0)
    fail_input(name, std::string("its metadata ") + key + " is " + format_number(value),
               "give what it was fitted to, or take the line out");
  return value;
}

}  // namespace

bool FittedRange::has_place(const Vec3& point) const noexcept {
  if (places.empty()) return true;
  const double square = kRounded * kRounded * reach * reach;
  return std::any_of(places.begin(), places.end(),
                     [&](const Vec3& p) { return (p - point).squaredNorm() <= square; });
}

FittedRange fitted_range(const Metadata& metadata, const std::string& name) {
  FittedRange range;
  range.depth = number_or_infinity(metadata, name, "depth");
  range.speed = number_or_infinity(metadata, name, "speed");
  range.reach = number_or_infinity(metadata, name, "reach");
  if (metadata.find("covers")) range.covers = number_or_infinity(metadata, name, "covers");
  const std::string text = metadata.find("places").value_or("");
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(' '); at < text.size();
       at = text.find_first_not_of(' ', at)) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    numbers.push_back(0);
    if (!parse_number(word, numbers.back()))
      fail_input(name, "its metadata places has " + shown(word),
                 "give x y z of each place, in metres");
    at = end;
  }
  if (numbers.size() % 3 != 0)
    fail_input(name, "its metadata places has " + std::to_string(numbers.size()) + " numbers",
               "give x y z of each place, in metres");
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    range.places.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return range;
}

void record_range(const Dataset& dataset, Metadata& metadata) {
  for (const char* key : {"speed", "places", "covers", "reach"}) metadata.remove(key);
  const bool timed = std::all_of(dataset.episodes.begin(), dataset.episodes.end(),
                                 [](const Episode& e) { return !e.view.t.empty(); });
  if (const double speed = timed ? fastest(dataset) : 0; speed > 0)
    metadata.set("speed", format_number(speed));
  if (dataset.bodies() > 1 || dataset.positions.empty()) return;
  double radius = 0, covers = 0;
  for (const Setup& setup : dataset.setups) radius = std::max(radius, setup.tool_radius);
  std::string text;
  for (const Vec3& p : apart(dataset.positions, covers))
    for (int k = 0; k < 3; ++k) {
      if (!text.empty()) text += ' ';
      text += format_number(std::round(kPerMetre * p[k]) / kPerMetre + 0.0);
    }
  double reach = kLeastReach * radius;
  if (dataset.positions.size() > 1) {
    std::vector<double> next;
    for (std::size_t p = 0; p < dataset.positions.size(); ++p)
      next.push_back(to_next(dataset.positions, p));
    const auto nine = next.begin() + static_cast<std::ptrdiff_t>(
                                         kNextShare * static_cast<double>(next.size() - 1) + 0.5);
    std::nth_element(next.begin(), nine, next.end());
    reach = std::max(reach, *nine);
  }
  metadata.set("places", text);
  if (covers > 0)
    metadata.set("covers", format_number(std::ceil(kPerMetre * covers + 1) / kPerMetre));
  metadata.set("reach", format_number(std::ceil(kPerMetre * (reach + covers) + 1) / kPerMetre));
}

double ToolSpeed::add(double t, const Vec3& u) noexcept {
  if (!begun_ || t < t_) {
    begun_ = true;
    speed_ = 0;
    t_ = t;
    u_ = u;
  } else if (t - t_ >= kTime) {
    speed_ = (u - u_).norm() / (t - t_);
    t_ = t;
    u_ = u;
  }
  return speed_;
}

}  // namespace hapsim
