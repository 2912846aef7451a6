#include "fusion/slow_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "io/csv.h"

namespace hapsim {
namespace {

// A row's place between two samples of the fast recording's press.
struct Between {
  std::size_t before, after;
  double share;  // of the way to `after`
};

std::optional<Between> between(const Recording& fast, const std::vector<int>& rows, double t) {
  const auto after = std::lower_bound(rows.begin(), rows.end(), t, [&](int row, double when) {
    return fast.t[static_cast<std::size_t>(row)] < when;
  });
  if (after == rows.end()) return std::nullopt;
  const auto b = static_cast<std::size_t>(*after);
  if (after == rows.begin())
    return fast.t[b] == t ? std::optional<Between>({b, b, 1}) : std::nullopt;
  const auto a = static_cast<std::size_t>(*(after - 1));
  const double step = fast.t[b] - fast.t[a];
  return Between{a, b, step > 0 ? (t - fast.t[a]) / step : 1};
}

// Slow forces of another motion, or of times counted otherwise, are off by its size; those of a
// sampling or a clock of their own by far less.
void require_same_motion(const Recording& fast, const Recording& slow) {
  double off = 0, size = 0;
  std::map<int, Press> presses;
  for (const Press& p : fast.presses()) presses[p.id] = p;
  for (std::size_t i = 0; i < slow.rows(); ++i) {
    const auto at = between(fast, presses[slow.press[i]].rows, slow.t[i]);
    if (!at) continue;
    off += ((1 - at->share) * fast.u[at->before] + at->share * fast.u[at->after] - slow.u[i])
               .squaredNorm();
    size += slow.u[i].squaredNorm();
  }
  if (off > 0.25 * size)
    fail_input(slow.name,
               fmt::format("its displacements are {:.0f} % off those of {} at the same times",
                           100 * std::sqrt(off / size), fast.name),
               "give the slow forces of the same motion, their t counted alike");
}

void require_same_rows(const Recording& stepped, const Recording& slow) {
  const std::string mend = "simulate the slow recording's own rows with the fast model";
  if (stepped.rows() != slow.rows())
    fail_input(stepped.name,
               fmt::format("it has {} rows, {} has {}", stepped.rows(), slow.name, slow.rows()),
               mend);
  double largest = 0;
  for (const Vec3& u : slow.u) largest = std::max(largest, u.norm());
  for (std::size_t i = 0; i < slow.rows(); ++i)
    if (stepped.press[i] != slow.press[i] || (stepped.u[i] - slow.u[i]).norm() > 1e-6 * largest ||
        stepped.t.empty() || std::abs(stepped.t[i] - slow.t[i]) > 1e-9 * (1 + std::abs(slow.t[i])))
      fail_input(fmt::format("{}:{}", stepped.name, stepped.line[i]),
                 "its press, t or displacement is not that of the row in " + slow.name, mend);
}

}  // namespace

SlowRows slow_rows(const Recording& fast, const SlowSource& slow) {
  const Recording& r = *slow.recording;
  for (const Recording* needed : {&fast, &r})
    if (needed->t.empty())
      fail_input(needed->name, "there is no column t", "forces are fused by their times");
  SlowRows rows;
  for (const Press& p : fast.presses()) rows[p.id];
  if (slow.stepped) require_same_rows(*slow.stepped, r);
  std::map<int, std::vector<int>> samples;
  for (const Press& p : fast.presses()) samples[p.id] = p.rows;
  const auto column = std::find(r.extra_header.begin(), r.extra_header.end(), "arrives");
  for (std::size_t i = 0; i < r.rows(); ++i) {
    const std::string where = fmt::format("{}:{}", r.name, r.line[i]);
    const auto found = rows.find(r.press[i]);
    if (found == rows.end())
      fail_input(where, fmt::format("press {} is not in {}", r.press[i], fast.name),
                 "give both recordings the same presses");
    if (r.in_air(i)) continue;
    SlowRow row{r.t[i], r.t[i] + slow.delay, r.f[i]};
    if (column != r.extra_header.end()) {
      const auto c = static_cast<std::size_t>(column - r.extra_header.begin());
      if (!parse_number(r.extra[c][i], row.arrives) || row.arrives < row.t)
        fail_input(where, "arrives is " + shown(r.extra[c][i]),
                   "give the time at which the row is there, not before its own [s]");
    }
    if (slow.stepped)
      if (const auto at = between(fast, samples[r.press[i]], r.t[i]))
        row.force += (1 - at->share) * fast.f[at->before] + at->share * fast.f[at->after] -
                     slow.stepped->f[i];
    found->second.push_back(row);
  }
  require_same_motion(fast, r);
  for (auto& [press, list] : rows)
    std::stable_sort(list.begin(), list.end(),
                     [](const SlowRow& a, const SlowRow& b) { return a.arrives < b.arrives; });
  return rows;
}

std::vector<SlowRows> paces_of(const SlowRows& rows) {
  std::vector<SlowRows> paces;
  for (const std::size_t times : {1, 3, 10}) {
    SlowRows& pace = paces.emplace_back();
    for (const auto& [press, list] : rows) {
      std::vector<SlowRow>& kept = pace[press];
      for (std::size_t k = 0; k < list.size(); k += times) {
        SlowRow row = list[k];
        row.arrives = row.t + static_cast<double>(times) * (row.arrives - row.t);
        kept.push_back(row);
      }
    }
  }
  return paces;
}

}  // namespace hapsim
