#include "recording/torque_columns.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

constexpr const char* kAtSensor[] = {"tx", "ty", "tz"};
constexpr const char* kOrigin = "torque_at";
constexpr const char* kUnused = "torques_unused";

using Places = std::array<std::size_t, 3>;  // in extra

std::optional<Places> places_of(const Recording& r, const char* const (&names)[3]) {
  Places at{};
  std::string missing;
  int count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find(r.extra_header.begin(), r.extra_header.end(), names[k]);
    if (found == r.extra_header.end()) {
      missing = names[k];
      continue;
    }
    at[k] = static_cast<std::size_t>(found - r.extra_header.begin());
    ++count;
  }
  if (count == 0) return std::nullopt;
  if (count < 3)
    fail_input(r.name, fmt::format("a torque without its component {}", missing),
               fmt::format("give all of {},{},{}, or none", names[0], names[1], names[2]));
  return at;
}

std::vector<Vec3> numbers(const Recording& r, const Places& at, const char* const (&names)[3]) {
  std::vector<Vec3> values(r.rows());
  BadCells bad;
  for (std::size_t row = 0; row < r.rows() && !bad.full(); ++row)
    for (std::size_t k = 0; k < 3; ++k)
      if (!parse_number(r.extra[at[k]][row], values[row][static_cast<Eigen::Index>(k)]))
        bad.add(names[k], r.line[row], r.extra[at[k]][row]);
  bad.fail_if_any(r.name);
  return values;
}

// Where the sensor's origin lies from the tip [m].
std::optional<Vec3> origin_of(const Recording& r) {
  const auto text = r.metadata.find(kOrigin);
  if (!text) return std::nullopt;
  std::istringstream words(*text);
  Vec3 at;
  std::string word;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (!(words >> word) || !parse_number(word, at[k]) || std::abs(at[k]) > 1)
      fail_input(r.name, fmt::format("{} is {}, not three lengths within 1 m", kOrigin, *text),
                 "say where the sensor's origin lies from the tip: '# torque_at: 0 0 0.12'");
  return at;
}

// Newton millimetres are a thousand times too many, and another point adds its distance.
void require_about_the_tip(const Recording& r, const std::vector<Vec3>& torques) {
  if (r.f.empty() || !r.metadata.find("tool_radius")) return;
  double torque = 0, force = 0;
  const double noise = r.metadata.number("torque_noise", r.name).value_or(0);
  for (std::size_t row = 0; row < r.rows(); ++row) {
    if (r.in_air(row)) continue;
    torque += torques[row].squaredNorm() - 3 * noise * noise;
    force += r.f[row].squaredNorm();
  }
  const double lever = force > 0 ? std::sqrt(std::max(0.0, torque) / force) : 0;
  const double radius = r.tool_radius();
  if (lever <= kMostLever * radius) return;
  fail_input(r.name,
             fmt::format("the torques are {:.3g} m times the forces, {:.3g} radii of the tool; "
                         "about its tip a body answers with less than one",
                         lever, lever / radius),
             "give tqx,tqy,tqz in N m (1 N mm is 0.001 N m), about the tool's tip; of torques "
             "about a sensor's origin (tx,ty,tz) say where it lies from the tip: "
             "'# torque_at: 0 0 0.12'; of torques that are mostly noise declare it (torque_noise)");
}

void take_away(Recording& r, const char* const (&names)[3]) {
  for (const char* name : names) {
    const auto found = std::find(r.extra_header.begin(), r.extra_header.end(), name);
    if (found == r.extra_header.end()) continue;
    r.extra.erase(r.extra.begin() + (found - r.extra_header.begin()));
    r.extra_header.erase(found);
  }
}

}  // namespace

Torques read_torques(const Recording& r) {
  Torques torques;
  if (const auto at = places_of(r, kTorqueColumns)) {
    torques.values = numbers(r, *at, kTorqueColumns);
  } else if (const auto raw = places_of(r, kAtSensor)) {
    const std::optional<Vec3> origin = origin_of(r);
    if (!origin || r.f.empty()) {
      torques.unused =
          "torques tx,ty,tz of the recording are about the sensor's origin and are not used: say "
          "where that lies from the tip, '# torque_at: X Y Z' [m]";
      return torques;
    }
    torques.values = numbers(r, *raw, kAtSensor);
    for (std::size_t row = 0; row < r.rows(); ++row) torques.values[row] += origin->cross(r.f[row]);
  }
  if (torques.values.empty()) torques.unused = r.metadata.find(kUnused).value_or("");
  const auto is_zero = [](const Vec3& torque) { return torque == Vec3::Zero(); };
  if (!torques.values.empty() &&
      std::all_of(torques.values.begin(), torques.values.end(), is_zero)) {
    torques.values.clear();
    torques.unused = "torques of the recording are all zero and are not used";
  }
  if (!torques.values.empty()) require_about_the_tip(r, torques.values);
  return torques;
}

bool has_tip_torques(const Recording& r) {
  return std::find(r.extra_header.begin(), r.extra_header.end(), kTorqueColumns[0]) !=
         r.extra_header.end();
}

bool has_torques(const Recording& r) {
  return has_tip_torques(r) || (r.metadata.find(kOrigin) && places_of(r, kAtSensor));
}

void set_torques(Recording& r, const std::vector<Vec3>& torques) {
  if (torques.empty()) {
    take_away(r, kTorqueColumns);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::string> column;
    for (const Vec3& torque : torques)
      column.push_back(format_number(torque[static_cast<Eigen::Index>(k)]));
    const auto found =
        std::find(r.extra_header.begin(), r.extra_header.end(), std::string(kTorqueColumns[k]));
    if (found == r.extra_header.end()) {
      r.extra_header.emplace_back(kTorqueColumns[k]);
      r.extra.push_back(std::move(column));
    } else {
      r.extra[static_cast<std::size_t>(found - r.extra_header.begin())] = std::move(column);
    }
  }
}

void forget_torques(Recording& r) {
  take_away(r, kTorqueColumns);
  take_away(r, kAtSensor);
  r.metadata.remove(kOrigin);
  forget_torque_noise(r.metadata);
}

void forget_torques_because(Recording& r, const std::string& why) {
  forget_torques(r);
  r.metadata.set(kUnused, "torques of the recording are not used: " + why);
}

bool tool_turns(const Recording& r) {
  for (std::size_t c = 0; c < r.extra_header.size(); ++c) {
    const std::string& name = r.extra_header[c];
    if (name != "thx" && name != "thy" && name != "thz") continue;
    const bool turned = std::any_of(r.extra[c].begin(), r.extra[c].end(), [](const auto& cell) {
      double value = 0;
      return parse_number(cell, value) && value != 0;
    });
    if (turned) return true;
  }
  return false;
}

Noise torque_noise(const Recording& r, const std::vector<Vec3>& torques) {
  constexpr double kLeast = 1e-18, kMost = 1e6;  // [N m]
  const auto declared = r.metadata.number("torque_noise", r.name);
  if (declared && *declared != 0) {
    if (!(*declared >= kLeast && *declared <= kMost))
      fail_input(r.name,
                 "torque_noise " + format_number(*declared) + " is not between 1e-18 and 1e6 N m",
                 "give the standard deviation of a component in N m, or remove the line");
    const auto how = r.metadata.find("torque_noise_from");
    return {*declared, false, how ? "estimated from " + *how : "declared"};
  }
  Recording as_forces;
  as_forces.press = r.press;
  as_forces.t = r.t;
  as_forces.u = r.u;
  as_forces.f = torques;
  const NoiseEstimate estimate = measure_force_noise(as_forces);
  if (estimate.sigma > 0) return {estimate.sigma, true, "measured from the data"};
  double peak = 0;
  for (const Vec3& torque : torques) peak = std::max(peak, torque.norm());
  return {1e-4 * peak, true, "measured from the data"};
}

void forget_torque_noise(Metadata& metadata) {
  for (const char* key : {"torque_noise", "torque_noise_from"}) metadata.remove(key);
}

}  // namespace hapsim
