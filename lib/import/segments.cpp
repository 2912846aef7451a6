#include "import/segments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "base/median.h"
#include "import/contact_onset.h"
#include "import/sliding.h"

namespace hapsim {
namespace {

constexpr double kSamePlace = 1e-7;  // [m]

using Rows = std::vector<int>;
using Groups = std::vector<Rows>;

// Cuts `rows` before each row for which `starts(previous, row, first of the piece)` holds.
template <class Starts>
Groups cut(const Rows& rows, Starts starts) {
  Groups groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || starts(rows[i - 1], rows[i], groups.back().front())) groups.emplace_back();
    groups.back().push_back(rows[i]);
  }
  return groups;
}

template <class Starts>
Groups cut_each(const Groups& groups, Starts starts) {
  Groups all;
  for (const Rows& rows : groups)
    for (Rows& piece : cut(rows, starts)) all.push_back(std::move(piece));
  return all;
}

// The place of the tool, if the table has one that moves.
const std::vector<Vec3>* moving_tip(const Samples& samples) {
  if (!samples[VectorRole::kTip].empty()) return &samples[VectorRole::kTip];
  if (!samples[VectorRole::kDeformed].empty()) return &samples[VectorRole::kDeformed];
  if (!samples[VectorRole::kPlain].empty() && !positions_stand_still(samples))
    return &samples[VectorRole::kPlain];
  return nullptr;
}

const std::vector<Vec3>* still_contact(const Samples& samples) {
  for (const VectorRole role : {VectorRole::kContact, VectorRole::kContactBall})
    if (!samples[role].empty()) return &samples[role];
  if (!samples[VectorRole::kPlain].empty() && positions_stand_still(samples))
    return &samples[VectorRole::kPlain];
  return nullptr;
}

double force_size(const Samples& samples, int row) {
  if (!samples[VectorRole::kForce].empty()) return samples[VectorRole::kForce][at(row)].norm();
  if (!samples[ScalarRole::kForce].empty()) return std::abs(samples[ScalarRole::kForce][at(row)]);
  return 0;
}

Groups by_key(const Samples& samples) {
  std::map<std::pair<std::string, int>, std::size_t> places;
  Groups groups;
  for (const int row : samples.usable) {
    const auto [place, fresh] =
        places.try_emplace({samples.key[at(row)], samples.block[at(row)]}, groups.size());
    if (fresh) groups.emplace_back();
    groups[place->second].push_back(row);
  }
  return groups;
}

// Repeated headers, and clocks that start again: a step back to before a quarter of what has
// passed.
Groups by_recording(const Samples& samples) {
  const auto& t = samples[ScalarRole::kTime];
  return cut(samples.usable, [&](int previous, int row, int first) {
    if (samples.block[at(row)] != samples.block[at(previous)]) return true;
    if (t.empty() || t[at(row)] >= t[at(previous)]) return false;
    return t[at(row)] <= t[at(first)] + 0.25 * (t[at(previous)] - t[at(first)]);
  });
}

Groups by_place(const Samples& samples, Groups groups) {
  if (const auto* contact = still_contact(samples))
    groups = cut_each(groups, [&](int previous, int row, int) {
      return ((*contact)[at(row)] - (*contact)[at(previous)]).norm() > kSamePlace;
    });
  const auto& count = samples[ScalarRole::kSample];
  if (!count.empty())
    groups = cut_each(
        groups, [&](int previous, int row, int) { return count[at(row)] < count[at(previous)]; });
  return groups;
}

// Jumps of the tip that are far longer than its usual steps.
Groups by_jump(const Samples& samples, const Groups& groups) {
  const auto* tip = moving_tip(samples);
  if (tip == nullptr) return groups;
  std::vector<double> steps;
  for (const Rows& rows : groups)
    for (std::size_t i = 1; i < rows.size(); ++i)
      steps.push_back(((*tip)[at(rows[i])] - (*tip)[at(rows[i - 1])]).norm());
  if (steps.empty()) return groups;
  const std::size_t upper_quarter = steps.size() * 3 / 4;
  const double usual = nth_smallest(std::move(steps), upper_quarter);
  return cut_each(groups, [&](int previous, int row, int) {
    return ((*tip)[at(row)] - (*tip)[at(previous)]).norm() > std::max(4 * usual, 5e-4);
  });
}

// Without a clock a depth that falls back by half of its range begins a new press.
Groups by_depth(const Samples& samples, const Groups& groups) {
  const auto& depth = samples[ScalarRole::kDepth];
  if (depth.empty() || !samples[ScalarRole::kTime].empty()) return groups;
  const auto [low, high] = std::minmax_element(depth.begin(), depth.end());
  const double half = (*high - *low) / 2;
  const auto by_value = [&](double sign) {
    return cut_each(groups, [&, sign](int previous, int row, int) {
      return sign * (depth[at(row)] - depth[at(previous)]) < -half;
    });
  };
  Groups up = by_value(1), down = by_value(-1);
  return up.size() <= down.size() || down.size() == groups.size() ? up : down;
}

// Returns of the force to zero, for at least three samples, between episodes that reach a fifth of
// the largest force. Cuts in the middle of the samples without contact.
Groups by_force(const Samples& samples, const Groups& groups) {
  Groups all;
  for (const Rows& rows : groups) {
    std::vector<double> force;
    for (const int row : rows) force.push_back(force_size(samples, row));
    if (force.size() < 8) {
      all.push_back(rows);
      continue;
    }
    const double rest = nth_smallest(force, force.size() / 50);
    const double top = *std::max_element(force.begin(), force.end()) - rest;
    const double low = rest + std::max(0.04 * top, 5 * difference_noise(force)),
                 high = rest + 0.2 * top;
    if (high <= low) {  // all of it is noise
      all.push_back(rows);
      continue;
    }
    Rows piece;
    bool pressed = false;
    std::size_t quiet = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (force[i] < low) ++quiet;
      if (force[i] > high && pressed && quiet >= 3) {
        // The approach of this press begins in the middle of the quiet samples before it.
        std::size_t begin = i;
        while (begin > 0 && force[begin - 1] >= low) --begin;
        begin -= std::min(begin, quiet / 2);
        const std::size_t back = i - begin;
        Rows next(piece.end() - static_cast<std::ptrdiff_t>(std::min(back, piece.size())),
                  piece.end());
        piece.resize(piece.size() - next.size());
        all.push_back(std::move(piece));
        piece = std::move(next);
        quiet = 0;
      }
      if (force[i] > high) {
        pressed = true;
        quiet = 0;
      }
      piece.push_back(rows[i]);
    }
    all.push_back(std::move(piece));
  }
  return all;
}

void put_in_order(const Samples& samples, Groups& groups, const std::string& file, Notes& notes) {
  const auto& t = samples[ScalarRole::kTime];
  if (t.empty()) return;
  std::size_t sorted = 0, repeated = 0, all = 0;
  for (Rows& rows : groups) {
    all += rows.size();
    std::size_t back = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) back += t[at(rows[i])] < t[at(rows[i - 1])];
    if (back) {
      sorted += back;
      std::stable_sort(rows.begin(), rows.end(),
                       [&t](int a, int b) { return t[at(a)] < t[at(b)]; });
    }
    const auto end =
        std::unique(rows.begin(), rows.end(), [&t](int a, int b) { return t[at(a)] == t[at(b)]; });
    repeated += static_cast<std::size_t>(rows.end() - end);
    rows.erase(end, rows.end());
  }
  if (2 * repeated > all)
    fail_input(file, fmt::format("{} of {} rows repeat a time of their press", repeated, all),
               "name the column that tells the presses apart by --split-by, or skip the time: "
               "--column TIME=skip");
  if (sorted)
    notes.warnings.push_back(
        fmt::format("time runs backwards {} times: rows were sorted by time", sorted));
  if (repeated)
    notes.warnings.push_back(fmt::format("{} rows that repeat a time are left out", repeated));
}

}  // namespace

bool positions_stand_still(const Samples& samples) {
  const auto& plain = samples[VectorRole::kPlain];
  if (plain.empty()) return false;
  const bool other = !samples[VectorRole::kTip].empty() ||
                     !samples[VectorRole::kDisplacement].empty() ||
                     !samples[ScalarRole::kDepth].empty();
  if (!other) return false;
  std::size_t still = 0;
  for (std::size_t i = 1; i < samples.usable.size(); ++i)
    still += (plain[at(samples.usable[i])] - plain[at(samples.usable[i - 1])]).norm() <= kSamePlace;
  return 2 * still >= samples.usable.size() - 1;
}

std::vector<Segment> find_segments(const Samples& samples, const std::string& by,
                                   const std::string& file, Notes& notes) {
  Groups groups;
  const bool named = !samples.key.empty();
  if (named) {
    groups = by_key(samples);
  } else {
    groups = by_recording(samples);
    if (by.empty()) groups = by_place(samples, std::move(groups));
    if (by.empty()) groups = by_depth(samples, groups);
  }
  const auto* tip = by.empty() ? moving_tip(samples) : nullptr;
  const bool sliding =
      tip && still_contact(samples) == nullptr &&
      std::count_if(groups.begin(), groups.end(),
                    [&](const Rows& rows) { return slides(*tip, samples, rows); }) *
              2 >
          static_cast<std::ptrdiff_t>(groups.size());
  if (by == "jump" || (by.empty() && !named && !sliding)) groups = by_jump(samples, groups);
  put_in_order(samples, groups, file, notes);
  if (sliding)
    notes.warnings.push_back(
        "the tool slides over the surface while it presses: no presses are cut out of it "
        "(--split-by force "
        "does); its touched points are a scan (--scan)");

  // A cut by force leaves the presses in one continuous recording.
  std::vector<Segment> segments;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const bool force =
        by == "force" || (by.empty() && !named && !sliding && !samples[ScalarRole::kTime].empty());
    for (Rows& rows : force ? by_force(samples, {groups[g]}) : Groups{groups[g]})
      segments.push_back({std::move(rows), static_cast<int>(g), sliding});
  }
  return segments;
}

}  // namespace hapsim
