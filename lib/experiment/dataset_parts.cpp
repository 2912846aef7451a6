#include "experiment/dataset_parts.h"

#include <algorithm>

namespace hapsim {
namespace {

constexpr int kLeftOut = -1;

// The recording of the rows that `episodes` name, which are renumbered.
Recording recording_of(const Recording& whole, std::vector<Episode>& episodes) {
  std::vector<int> row(whole.rows(), kLeftOut);
  for (const Episode& e : episodes)
    for (const int r : e.rows) row[static_cast<std::size_t>(r)] = 0;
  Recording part = whole;
  each_column(part, [&](auto& column) {
    if (column.empty()) return;
    std::size_t to = 0;
    for (std::size_t r = 0; r < row.size(); ++r)
      if (row[r] != kLeftOut) column[to++] = column[r];
    column.resize(to);
  });
  int next = 0;
  for (int& r : row)
    if (r != kLeftOut) r = next++;
  for (Episode& e : episodes)
    for (int& r : e.rows) r = row[static_cast<std::size_t>(r)];
  return part;
}

}  // namespace

Dataset at_positions(const Dataset& dataset, const std::vector<std::size_t>& positions) {
  Dataset result;
  result.setups = dataset.setups;
  std::vector<int> renumbered(dataset.positions.size(), kLeftOut);
  for (const std::size_t p : positions) {
    renumbered[p] = static_cast<int>(result.positions.size());
    result.positions.push_back(dataset.positions[p]);
    result.setup_of.push_back(dataset.setup_of[p]);
    if (!dataset.label.empty()) result.label.push_back(dataset.label[p]);
    if (!dataset.doubt.empty()) result.doubt.push_back(dataset.doubt[p]);
    if (!dataset.curve_doubt.empty()) result.curve_doubt.push_back(dataset.curve_doubt[p]);
  }
  for (const Episode& e : dataset.episodes) {
    const int position = renumbered[static_cast<std::size_t>(e.position)];
    if (position == kLeftOut) continue;
    result.episodes.push_back(e);
    result.episodes.back().position = position;
    result.episodes.back().view.number = static_cast<int>(result.episodes.size());
  }
  result.recording = recording_of(dataset.recording, result.episodes);
  return result;
}

Dataset beginnings(const Dataset& dataset, const std::vector<std::size_t>& samples) {
  Dataset result = dataset;
  result.episodes.clear();
  for (std::size_t k = 0; k < dataset.episodes.size(); ++k) {
    const std::size_t count = std::min(samples[k], dataset.episodes[k].rows.size());
    if (count == 0) continue;
    Episode& e = result.episodes.emplace_back(dataset.episodes[k]);
    const auto cut = [count](auto& column) { column.resize(std::min(column.size(), count)); };
    cut(e.rows);
    cut(e.view.t);
    cut(e.view.session);
    cut(e.view.u);
    cut(e.view.in_air);
    cut(e.view.temperature);
    e.view.number = static_cast<int>(result.episodes.size());
  }
  result.recording = recording_of(dataset.recording, result.episodes);
  return result;
}

}  // namespace hapsim
