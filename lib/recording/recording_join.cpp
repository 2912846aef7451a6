#include "recording/recording_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "io/number.h"
#include "recording/force_noise.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

void require_alike(const Recording& first, const Recording& next) {
  const auto differ = [&](const std::string& what) {
    fail_input(next.name, fmt::format("{} than in {}", what, first.name),
               "fit together only recordings made alike");
  };
  const auto told = [](const Recording& r, const char* key, const char* otherwise) {
    return r.metadata.find(key).value_or(otherwise);
  };
  if (told(next, "tool", "flat") != told(first, "tool", "flat")) differ("another tool");
  if (told(next, "recovery", "") != told(first, "recovery", "")) differ("another recovery");
  bool alike = next.t.empty() == first.t.empty() && next.f.empty() == first.f.empty();
  std::string optional;
  for (const OptionalColumn& column : kOptionalColumns) {
    alike = alike && (next.*column.values).empty() == (first.*column.values).empty();
    optional += std::string(", ") + column.name;
  }
  if (!alike) differ("other columns (t" + optional + " or forces)");
}

// The declared noise of all together: none unless each declares one.
void pool_noise(const std::vector<Recording>& recordings, Recording& all) {
  double squares = 0, rows = 0;
  bool alike = true;
  for (const Recording& r : recordings) {
    const std::optional<double> noise = r.force_noise();
    alike = alike && noise == recordings.front().force_noise();
    if (!noise) rows = std::numeric_limits<double>::quiet_NaN();
    squares += noise.value_or(0) * noise.value_or(0) * static_cast<double>(r.rows());
    rows += static_cast<double>(r.rows());
  }
  if (alike) return;
  forget_force_noise(all.metadata);
  if (!std::isnan(rows)) all.metadata.set("force_noise", format_number(std::sqrt(squares / rows)));
}

// Torques where each recording has them; their noise where all declare the same.
void join_torques(const std::vector<Recording>& recordings, Recording& all) {
  std::vector<Vec3> torques;
  bool alike = true, any = false;
  std::string without;
  for (const Recording& r : recordings) {
    const Torques read = read_torques(r);
    const std::vector<Vec3>& own = read.values;
    any = any || !own.empty() || !read.unused.empty();
    if (!own.empty() && tool_turns(r)) without = "in " + r.name + " the tool turns";
    if (own.empty()) without = r.name + " has none";
    alike = alike &&
            r.metadata.find("torque_noise") == recordings.front().metadata.find("torque_noise");
    torques.insert(torques.end(), own.begin(), own.end());
  }
  all.metadata.remove("torque_at");
  if (!without.empty()) {
    forget_torques(all);
    if (any) forget_torques_because(all, without);
    return;
  }
  if (!alike) forget_torque_noise(all.metadata);
  set_torques(all, torques);
}

}  // namespace

Recording join_recordings(const std::vector<Recording>& recordings) {
  Recording all = recordings.front();
  if (recordings.size() == 1) return all;
  all.extra_header.clear();
  all.extra.clear();
  const bool has_contact = std::any_of(recordings.begin(), recordings.end(),
                                       [](const Recording& r) { return !r.contact.empty(); });
  if (has_contact && all.contact.empty()) all.contact.assign(all.rows(), 1);
  for (std::size_t k = 1; k < recordings.size(); ++k) {
    const Recording& next = recordings[k];
    require_alike(recordings.front(), next);
    if (next.metadata.find("recovery").value_or("") == "none")
      fail_input(next.name, "what the body remembers of earlier recordings is not known",
                 "fit recordings with 'recovery: none' one by one");
    const int number = 1 + *std::max_element(all.press.begin(), all.press.end()) -
                       *std::min_element(next.press.begin(), next.press.end());
    for (const int press : next.press) all.press.push_back(number + press);
    if (!all.t.empty()) {
      const double start = 1 + *std::max_element(all.t.begin(), all.t.end()) -
                           *std::min_element(next.t.begin(), next.t.end());
      for (const double t : next.t) all.t.push_back(start + t);
    }
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all.line, next.line);
    append(all.position, next.position);
    append(all.u, next.u);
    append(all.f, next.f);
    for (const OptionalColumn& column : kOptionalColumns)
      append(all.*column.values, next.*column.values);
    append(all.contact, next.contact);
    if (has_contact) all.contact.resize(all.rows(), 1);
  }
  pool_noise(recordings, all);
  join_torques(recordings, all);
  return all;
}

}  // namespace hapsim
