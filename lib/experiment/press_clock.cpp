#include "experiment/press_clock.h"

#include <algorithm>

#include "base/error.h"

namespace hapsim {

PressClock::PressClock(const MarkerTable& table, const Dataset& dataset)
    : table_(table), dataset_(dataset) {
  const Recording& r = dataset.recording;
  if (r.t.empty())
    fail_input(table.name, r.name + " has no times to match the points' with",
               "give the recording a column t");
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e)
    for (const int row : dataset.episodes[e].rows)
      rows_[table.press.empty() ? 0 : r.press[static_cast<std::size_t>(row)]].emplace_back(
          row, static_cast<int>(e));
  if (!table.press.empty()) return;
  const auto& all = rows_[0];
  for (std::size_t i = 1; i < all.size(); ++i)
    if (time(all[i].first) < time(all[i - 1].first))
      fail_input(table.name,
                 "time begins anew with each press of " + r.name +
                     ", so that it does not say in which press a point was seen",
                 "give the table a column press");
}

double PressClock::time(int row) const {
  return dataset_.recording.t[static_cast<std::size_t>(row)];
}

PressTime PressClock::of_row(std::size_t row) const {
  return find(table_.press.empty() ? 0 : table_.press[row], table_.t[row]);
}

PressTime PressClock::find(int press, double t) const {
  // Text and binary may differ in the last digit of a time.
  constexpr double kSameTime = 1e-9;  // [s]
  const auto found = rows_.find(press);
  if (found == rows_.end()) return {};
  const auto& rows = found->second;
  const auto next = std::lower_bound(
      rows.begin(), rows.end(), t - kSameTime,
      [&](const std::pair<int, int>& row, double value) { return time(row.first) < value; });
  if (next == rows.end()) return {};
  const auto second = static_cast<std::size_t>(next->first);
  if (time(next->first) <= t + kSameTime) return {next->second, second, second, 0};
  if (next == rows.begin()) return {};
  const auto before = next - 1;
  const auto first = static_cast<std::size_t>(before->first);
  const std::vector<int>& of = dataset_.recording.press;
  if (before->second != next->second || of[first] != of[second]) return {};
  return {next->second, first, second,
          (t - time(before->first)) / (time(next->first) - time(before->first))};
}

bool PressClock::in_air(const PressTime& at) const {
  return dataset_.recording.in_air(at.first) || dataset_.recording.in_air(at.second);
}

Vec3 PressClock::displacement(const PressTime& at) const {
  const Recording& r = dataset_.recording;
  if (in_air(at)) return Vec3::Zero();
  return (1 - at.share) * r.u[at.first] + at.share * r.u[at.second];
}

}  // namespace hapsim
