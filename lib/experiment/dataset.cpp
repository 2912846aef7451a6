#include "experiment/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/median.h"
#include "recording/ceiling.h"

namespace hapsim {
namespace {

// The number of the setup in `setups`, where it is put if it is not there.
int number_of(const Setup& setup, std::vector<Setup>& setups) {
  const auto found = std::find(setups.begin(), setups.end(), setup);
  if (found != setups.end()) return static_cast<int>(found - setups.begin());
  setups.push_back(setup);
  return static_cast<int>(setups.size()) - 1;
}

constexpr int kNowhere = -1;

// The number of a contact point; kNowhere when it is not there.
int find_position(const Vec3& point, int setup, const Dataset& dataset) {
  for (std::size_t p = 0; p < dataset.positions.size(); ++p)
    if (dataset.setup_of[p] == setup && (dataset.positions[p] - point).norm() <= kSamePlace)
      return static_cast<int>(p);
  return kNowhere;
}

int new_position(const Vec3& point, int setup, Dataset& dataset) {
  dataset.positions.push_back(point);
  dataset.setup_of.push_back(setup);
  return static_cast<int>(dataset.positions.size()) - 1;
}

// Any place of the setup, for a press that never touches: none is prepared for it alone.
int any_position(const Vec3& point, int setup, Dataset& dataset) {
  const auto found = std::find(dataset.setup_of.begin(), dataset.setup_of.end(), setup);
  if (found == dataset.setup_of.end()) return new_position(point, setup, dataset);
  return static_cast<int>(found - dataset.setup_of.begin());
}

template <class Value>
std::size_t distinct(const std::vector<Setup>& setups, const Value& value) {
  std::vector<double> values;
  for (const Setup& s : setups) values.push_back(value(s));
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

}  // namespace

std::size_t Dataset::bodies() const {
  return distinct(setups, [](const Setup& s) { return static_cast<double>(s.body); });
}
std::size_t Dataset::tools() const {
  return distinct(setups, [](const Setup& s) { return s.tool_radius; });
}

double Dataset::floor_at(std::size_t position, double floor) const {
  return doubt.empty() ? floor : std::hypot(floor, doubt[position]);
}

double session_start(const Recording& recording) {
  return recording.t.empty() ? 0 : *std::min_element(recording.t.begin(), recording.t.end());
}

void add_sample(PressView& press, const Recording& recording, std::size_t row, double press_start,
                double session_start) {
  press.u.push_back(recording.u[row]);
  press.in_air.push_back(recording.in_air(row) ? 1 : 0);
  if (!recording.temp.empty()) press.temperature.push_back(recording.temp[row]);
  if (recording.t.empty()) return;
  press.t.push_back(recording.t[row] - press_start);
  press.session.push_back(recording.t[row] - session_start);
}

Dataset make_dataset(Recording recording, const std::vector<Setup>& setup_of_row) {
  Dataset dataset;
  const Setup only{0, setup_of_row.empty() ? recording.disc_radius() : 0};
  const bool relaxed = recording.metadata.find("recovery").value_or("") != "none";
  const double began = session_start(recording);
  for (const Press& press : recording.presses()) {
    const Vec3& point = recording.position[press.rows.front()];
    for (const int row : press.rows)
      if ((recording.position[row] - point).norm() > kSamePlace)
        fail_input(fmt::format("{}:{}", recording.name, recording.line[row]),
                   fmt::format("the contact point moves within press {}", press.id),
                   "give each contact point its own press number");
    const int setup =
        number_of(setup_of_row.empty() ? only : setup_of_row[press.rows.front()], dataset.setups);
    const bool touches = std::any_of(press.rows.begin(), press.rows.end(), [&](int row) {
      return !recording.in_air(static_cast<std::size_t>(row));
    });
    int position = find_position(point, setup, dataset);
    if (position == kNowhere && touches) position = new_position(point, setup, dataset);
    const bool goes_on =
        !relaxed && !dataset.episodes.empty() && dataset.episodes.back().position == position &&
        !recording.t.empty() &&
        recording.t[press.rows.front()] >= recording.t[dataset.episodes.back().rows.back()];
    if (!goes_on) {
      dataset.episodes.emplace_back();
      dataset.episodes.back().position = position;
      dataset.episodes.back().view.radius = dataset.setups[setup].tool_radius;
      dataset.episodes.back().view.number = static_cast<int>(dataset.episodes.size());
    }
    Episode& episode = dataset.episodes.back();
    const double start =
        recording.t.empty() ? 0 : recording.t[goes_on ? episode.rows.front() : press.rows.front()];
    for (const int row : press.rows) {
      episode.rows.push_back(row);
      add_sample(episode.view, recording, static_cast<std::size_t>(row), start, began);
    }
  }
  for (Episode& e : dataset.episodes)
    if (e.position == kNowhere)
      e.position = any_position(
          recording.position[e.rows.front()],
          number_of(setup_of_row.empty() ? only : setup_of_row[e.rows.front()], dataset.setups),
          dataset);
  dataset.recording = std::move(recording);
  return dataset;
}

Dataset on_body(Dataset dataset, const std::vector<ToolStand>& stands) {
  const bool heals = dataset.recording.metadata.find("recovery").value_or("") == "full";
  std::vector<double> deepest(dataset.positions.size(), 0.0);
  for (Episode& e : dataset.episodes) {
    e.view.point = dataset.positions[e.position];
    e.view.normal = stands[e.position].normal;
    e.view.height = stands[e.position].height;
    e.view.direction = -e.view.normal;
    if (!heals) e.view.past_depth = deepest[e.position];
    double depth = 0;
    for (std::size_t i = 0; i < e.view.size(); ++i) {
      const Vec3& u = e.view.u[i];
      if (u.norm() <= depth || u.dot(e.view.normal) > 0 || e.view.in_air[i]) continue;
      depth = u.norm();
      e.view.direction = u / depth;
    }
    deepest[e.position] = std::max(deepest[e.position], depth);
  }
  return dataset;
}

DataSummary summarise(const Dataset& dataset, double modulus) {
  DataSummary summary;
  summary.has_time = !dataset.recording.t.empty();
  summary.modulus = modulus;
  summary.tool_radius = dataset.setups.front().tool_radius;
  summary.presses = dataset.recording.presses().size();
  if (dataset.tools() == 1 && dataset.recording.has_ball())
    summary.ball_radius = dataset.recording.tool_radius();
  summary.peak_force = summary.peak_along = summary.peak_across = 1e-12;
  const auto ceilings = find_ceilings(dataset.recording.f);
  for (std::size_t k = 0; k < 3; ++k)
    if (ceilings[k].reached()) summary.ceiling[static_cast<Eigen::Index>(k)] = ceilings[k].force;
  const std::vector<double>& temp = dataset.recording.temp;
  if (!temp.empty())
    summary.temperature = dataset.recording.metadata.number("temp_ref", dataset.recording.name)
                              .value_or(std::accumulate(temp.begin(), temp.end(), 0.0) /
                                        static_cast<double>(temp.size()));
  std::vector<double> steps, durations;
  double deepest = 0;
  for (const Episode& e : dataset.episodes) {
    for (std::size_t i = 0; i < e.rows.size(); ++i) {
      if (!dataset.recording.f.empty()) {
        const Vec3& f = dataset.recording.f[e.rows[i]];
        summary.peak_force = std::max(summary.peak_force, f.norm());
        summary.peak_along = std::max(summary.peak_along, std::abs(f.z()));
        summary.peak_across = std::max(summary.peak_across, f.head<2>().norm());
      }
      deepest = std::max(deepest, e.view.u[i].norm());
      if (summary.has_time && i > 0) steps.push_back(e.view.t[i] - e.view.t[i - 1]);
    }
    if (!summary.has_time) continue;
    durations.push_back(e.view.t.back());
    summary.session = std::max(summary.session, e.view.session.back());
  }
  summary.sample_step = upper_median(steps);
  summary.press_duration = upper_median(durations);
  if (deepest > 0) summary.depth = deepest;
  if (deepest > 0) summary.peak_stiffness = summary.peak_force / deepest;
  return summary;
}

}  // namespace hapsim
