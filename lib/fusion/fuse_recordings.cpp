#include "fusion/fuse_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "estimate/simplex_search.h"
#include "io/csv.h"

namespace hapsim {
namespace {

struct SlowRow {
  double t = 0, arrives = 0;
  Vec3 force = Vec3::Zero();
};

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

using SlowRows = std::map<int, std::vector<SlowRow>>;  // by press, in the order of arrival

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

// Where the data say nothing, parameters stay within a factor of about e^3 of the start.
constexpr double kPrior = 3;
// Observations that learned shares are worth: as many as half the memory for what they have been.
constexpr double kLearnedShares = 20;

class Run {
 public:
  Run(const Recording& fast, const FusionParameters& parameters)
      : fast_(fast), fusion_(parameters, std::max<std::size_t>(longest(fast) + 2, 16)) {}

  FusedForces operator()(const SlowRows& slow) {
    FusedForces out;
    for (auto* list : {&out.force, &out.deviation, &out.held, &out.extrapolated})
      list->assign(fast_.rows(), Vec3::Zero());
    for (const Press& press : fast_.presses()) {
      const std::vector<SlowRow>& rows = slow.at(press.id);
      std::size_t next = 0;
      const SlowRow *last = nullptr, *before = nullptr;  // by their own times
      const auto start = static_cast<std::size_t>(press.rows.front());
      fusion_.begin(fast_.t[start], fast_.position[start]);
      for (const int row : press.rows) {
        const auto i = static_cast<std::size_t>(row);
        const double t = fast_.t[i];
        // What arrives between two samples counts from the second.
        const Vec3 force = fusion_.step(t, fast_.u[i], fast_.f[i]);
        for (; next < rows.size() && rows[next].arrives <= t; ++next) {
          fusion_.observe(rows[next].t, rows[next].force);
          if (last != nullptr && rows[next].t <= last->t) continue;
          before = last;
          last = &rows[next];
        }
        if (fast_.in_air(i)) continue;
        out.force[i] = force;
        out.deviation[i] = fusion_.deviation();
        if (last != nullptr) out.held[i] = out.extrapolated[i] = last->force;
        if (before != nullptr)
          out.extrapolated[i] +=
              (t - last->t) / (last->t - before->t) * (last->force - before->force);
      }
    }
    out.report = fusion_.report();
    return out;
  }
  const CorrectionWorth& worth() const { return fusion_.worth(); }

 private:
  static std::size_t longest(const Recording& r) {
    std::size_t most = 0;
    for (const Press& p : r.presses()) most = std::max(most, p.rows.size());
    return most;
  }
  const Recording& fast_;
  Fusion fusion_;
};

// What is learned and written of each component, in one table.
struct Entry {
  const char* name;
  const char* unit;
  double AxisFusion::*value;
  double lower, upper;
};
constexpr std::size_t kLearned = 9;  // the first ones
const std::array<Entry, 10>& entries() {
  static const std::array<Entry, 10> table{{
      {"offset_walk", "N/s^0.5", &AxisFusion::offset_walk, 1e-9, 1e3},
      {"walk_rate", "m/s", &AxisFusion::walk_rate, 1e-3, 1e6},
      {"offset_time", "s", &AxisFusion::offset_time, 1e-3, 1e6},
      {"drift_walk", "N/s^1.5", &AxisFusion::drift_walk, 1e-9, 1e3},
      {"drift_time", "s", &AxisFusion::drift_time, 1e-3, 1e3},
      {"gain_walk", "1", &AxisFusion::gain_walk, 1e-9, 1e3},
      {"gain_spread", "1", &AxisFusion::gain_spread, 1e-6, 1e3},
      {"noise", "N", &AxisFusion::noise, 1e-9, 1e3},
      {"noise_rise", "N s/m", &AxisFusion::noise_rise, 1e-9, 1e3},
      {"force_scale", "N", &AxisFusion::force_scale, 1e-6, 1e6},
  }};
  return table;
}
constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};

std::vector<LessonPress> lessons_of(const Recording& fast, const SlowRows& slow) {
  std::vector<LessonPress> lessons;
  for (const Press& press : fast.presses()) {
    LessonPress lesson;
    lesson.contact = fast.position[static_cast<std::size_t>(press.rows.front())];
    for (const int row : press.rows) {
      const auto i = static_cast<std::size_t>(row);
      lesson.t.push_back(fast.t[i]);
      lesson.u.push_back(fast.u[i]);
      lesson.fast.push_back(fast.f[i]);
    }
    for (const SlowRow& row : slow.at(press.id)) {
      lesson.slow_t.push_back(row.t);
      lesson.slow.push_back(row.force);
    }
    lessons.push_back(std::move(lesson));
  }
  return lessons;
}

// Slow forces as they come, and so many times as seldom and as late: what is learned of them serves
// at any of these paces.
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

CorrectionShares shares_of(const Recording& fast, const std::vector<SlowRows>& paces,
                           const FusionParameters& parameters) {
  CorrectionWorth worth;
  for (const SlowRows& pace : paces) {
    Run run(fast, parameters);
    run(pace);
    worth.add(run.worth());
  }
  return worth.shares(parameters.share);
}

double* share_named(CorrectionShares& shares, const std::string& name) {
  for (std::size_t c = 0; c < kWayBands; ++c)
    if (name == fmt::format("share{}", c)) return &shares.way[c];
  for (std::size_t c = 0; c < kAgeBands; ++c)
    if (name == fmt::format("age_share{}", c)) return &shares.age[c];
  return nullptr;
}

// What was taught, in the table: its scale and times, then the weights.
struct TaughtEntry {
  std::string name, axis, unit;
  double* value;
};
std::vector<TaughtEntry> taught_entries(TaughtCorrection& taught) {
  std::vector<TaughtEntry> entries;
  for (std::size_t a = 0; a < 3; ++a)
    entries.push_back({"taught_scale", kAxes[a], "m", &taught.scale[static_cast<int>(a)]});
  for (std::size_t a = 0; a < 3; ++a)
    entries.push_back({"taught_place", kAxes[a], "m", &taught.place[static_cast<int>(a)]});
  entries.push_back({"taught_reach", "", "m", &taught.reach});
  for (std::size_t m = 0; m < TaughtCorrection::kTimes; ++m)
    entries.push_back({fmt::format("taught_time{}", m + 1), "", "s", &taught.time[m]});
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t k = 0; k < TaughtCorrection::kWeights; ++k)
      entries.push_back({fmt::format("taught{}", k + 1), kAxes[a], "N", &taught.weight[a][k]});
  return entries;
}

}  // namespace

FusedForces fuse(const Recording& fast, const SlowSource& slow,
                 const FusionParameters& parameters) {
  return Run(fast, parameters)(slow_rows(fast, slow));
}

LearnedFusion learn_fusion(const Recording& source, const SlowSource& slow,
                           const FusionParameters& start) {
  const SlowRows rows = slow_rows(source, slow);
  const std::vector<SlowRows> paces = paces_of(rows);
  std::size_t count = 0;
  for (const auto& [press, list] : rows) count += list.size();
  if (count < 20)
    fail_input(slow.recording->name, fmt::format("{} slow forces are too few to learn from", count),
               "give 20 or more, or parameters");
  LearnedFusion result;
  result.converged = true;
  result.parameters = start;
  // What is left of a press is learned with what the others teach of it.
  const Taught taught = teach(lessons_of(source, rows),
                              source.metadata.find("tool_radius") ? source.tool_radius() : 0);
  result.parameters.taught = {};
  Recording fast = source;
  std::size_t lesson = 0;
  for (const Press& press : source.presses()) {
    for (std::size_t k = 0; k < press.rows.size(); ++k)
      fast.f[static_cast<std::size_t>(press.rows[k])] += taught.by_others[lesson][k];
    ++lesson;
  }
  for (int a = 0; a < 3; ++a) {  // the components do not know of each other
    AxisFusion& axis = result.parameters.axis[static_cast<std::size_t>(a)];
    axis.force_scale = 1e-6;
    for (const Vec3& f : fast.f) axis.force_scale = std::max(axis.force_scale, std::abs(f[a]));
    // Starts are of the size of the forces.
    axis.offset_walk *= axis.force_scale;
    axis.drift_walk *= axis.force_scale;
    axis.noise *= axis.force_scale;
    axis.noise_rise *= axis.force_scale;
    const AxisFusion from = axis;
    const auto at = [&](const Eigen::VectorXd& x) {
      FusionParameters p = result.parameters;
      AxisFusion& here = p.axis[static_cast<std::size_t>(a)];
      for (std::size_t i = 0; i < kLearned; ++i)
        here.*(entries()[i].value) = std::clamp(std::exp(x[static_cast<Eigen::Index>(i)]),
                                                entries()[i].lower, entries()[i].upper);
      here.noise = std::max(here.noise, 1e-5 * here.force_scale);  // numbers as they are written
      return p;
    };
    Eigen::VectorXd x(static_cast<Eigen::Index>(kLearned));
    for (std::size_t i = 0; i < kLearned; ++i)
      x[static_cast<Eigen::Index>(i)] = std::log(from.*(entries()[i].value));
    SimplexSearchOptions options;
    options.tolerance = 0.02;
    options.value_tolerance = 0.1;  // of twice a log likelihood
    options.most_evaluations = 2000;
    const SimplexSearchResult found = simplex_search(
        x,
        [&](const Eigen::VectorXd& y) {
          FusionParameters p = at(y);  // the filter's own: what is let in of it comes after
          p.weighs = false;
          double deviance = (y - x).squaredNorm() / (kPrior * kPrior);
          // As much by each pace as by another, though there are fewer slow forces.
          for (const SlowRows& pace : paces) {
            const FusionReport r = Run(fast, p)(pace).report;
            deviance += static_cast<double>(count) * r.deviance[a] /
                        static_cast<double>(std::max(r.observations, 1L) * paces.size());
          }
          return deviance;
        },
        options);
    result.parameters = at(found.x);
    result.converged = result.converged && found.converged;
    result.runs += found.evaluations;
  }
  result.parameters.share = shares_of(fast, paces, result.parameters);
  result.parameters.share_known = kLearnedShares;
  result.parameters.taught = taught.correction;
  return result;
}

ForceQuality force_quality(const Recording& motion, const std::vector<Vec3>& force,
                           const std::vector<Vec3>& exact) {
  ForceQuality quality;
  double squares = 0, rows = 0;
  for (const Press& press : motion.presses())
    for (std::size_t k = 0; k < press.rows.size(); ++k) {
      const auto i = static_cast<std::size_t>(press.rows[k]);
      if (motion.in_air(i)) continue;
      squares += (force[i] - exact[i]).squaredNorm();
      rows += 3;
      if (k == 0) continue;
      const auto before = static_cast<std::size_t>(press.rows[k - 1]);
      const double dt = motion.t[i] - motion.t[before];
      if (dt > 0)
        quality.largest_step =
            std::max(quality.largest_step, (force[i] - force[before]).norm() * 1e-3 / dt);
    }
  if (rows > 0) quality.rms = std::sqrt(squares / rows);
  return quality;
}

FusionParameters read_fusion(Input& input) {
  const CsvTable csv = read_csv(input);
  FusionParameters parameters;
  const std::vector<TaughtEntry> taught = taught_entries(parameters.taught);
  const std::vector<double> value = csv.numbers("value");
  const int column = csv.find("parameter"), axes = csv.find("axis");
  for (const auto& [found, name] : {std::pair{column, "parameter"}, std::pair{axes, "axis"}})
    if (found < 0) fail_missing_column(csv.name, name, csv.header);
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::string& name = csv.columns[static_cast<std::size_t>(column)][row];
    const std::string& axis = csv.columns[static_cast<std::size_t>(axes)][row];
    const std::string where = csv.name + ":" + std::to_string(csv.line[row]);
    const auto bounded = [&](double lower, double upper) {
      if (value[row] < lower || value[row] > upper)
        fail_input(where, name + " = " + format_number(value[row]) + " is out of its bounds",
                   fmt::format("give {:g} to {:g}", lower, upper));
      return value[row];
    };
    if (double* share = share_named(parameters.share, name)) {
      *share = bounded(0, 1);
      continue;
    }
    if (name == "share_known") {
      parameters.share_known = bounded(0.1, 1e6);
      continue;
    }
    if (name == "blend") {
      parameters.blend = bounded(0, 10);
      continue;
    }
    const auto lesson = std::find_if(taught.begin(), taught.end(), [&](const TaughtEntry& e) {
      return e.name == name && e.axis == axis;
    });
    if (lesson != taught.end()) {
      *lesson->value = lesson->unit == "N"   ? bounded(-1e9, 1e9)
                       : lesson->unit == "s" ? bounded(1e-9, 1e6)
                                             : bounded(-1e3, 1e3);
      continue;
    }
    const auto found = std::find_if(entries().begin(), entries().end(),
                                    [&](const Entry& e) { return name == e.name; });
    const auto a =
        static_cast<std::size_t>(std::find(kAxes.begin(), kAxes.end(), axis) - kAxes.begin());
    if (found == entries().end() || a == kAxes.size())
      fail_input(where, "parameter " + shown(name) + " of axis " + shown(axis) + " is not known",
                 "see hs-fuse(1)");
    parameters.axis[a].*(found->value) = bounded(found->lower, found->upper);
  }
  return parameters;
}

void write_fusion(std::ostream& out, const FusionParameters& parameters) {
  CsvWriter csv(out, {}, {"parameter", "axis", "value", "unit"});
  for (std::size_t a = 0; a < 3; ++a)
    for (const Entry& e : entries())
      csv.row({e.name, kAxes[a], format_number(parameters.axis[a].*(e.value)), e.unit});
  csv.row({"blend", "", format_number(parameters.blend), "s"});
  for (std::size_t c = 0; c < kWayBands; ++c)
    csv.row({fmt::format("share{}", c), "", format_number(parameters.share.way[c]), "1"});
  for (std::size_t c = 0; c < kAgeBands; ++c)
    csv.row({fmt::format("age_share{}", c), "", format_number(parameters.share.age[c]), "1"});
  csv.row({"share_known", "", format_number(parameters.share_known), "1"});
  TaughtCorrection taught = parameters.taught;
  if (!taught.taught()) return;
  for (const TaughtEntry& e : taught_entries(taught))
    csv.row({e.name, e.axis, format_number(*e.value), e.unit});
}

}  // namespace hapsim
