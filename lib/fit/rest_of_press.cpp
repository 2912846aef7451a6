#include "fit/rest_of_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/median.h"

namespace hapsim {

Recording beginning_of_presses(const Recording& recording, double seconds,
                               std::vector<Setup>& setup_of_row) {
  if (recording.t.empty())
    fail_input(recording.name, "there is no column t, so there is no later", "record the times");
  if (recording.metadata.find("recovery").value_or("") == "none")
    fail_input(recording.name, "it says 'recovery: none', so its presses cannot be cut",
               "leave whole presses out instead (--folds)");
  std::vector<char> keep(recording.rows(), 0);
  for (const Press& press : recording.presses())
    for (const int row : press.rows)
      keep[row] = recording.t[row] - recording.t[press.rows.front()] <= seconds;
  if (std::find(keep.begin(), keep.end(), 0) == keep.end())
    fail_input(recording.name, fmt::format("no press is longer than {:g} s", seconds),
               "give a shorter time");
  Recording cut = recording;
  const auto thin = [&](auto& column) {
    if (column.empty()) return;
    std::size_t to = 0;
    for (std::size_t row = 0; row < keep.size(); ++row)
      if (keep[row] != 0) column[to++] = column[row];
    column.resize(to);
  };
  each_column(cut, thin);
  thin(setup_of_row);
  return cut;
}

LaterError later_error(const Fit& fitted, const Dataset& whole, double seconds) {
  const Selection all = all_episodes(whole);
  const MaterialSpec material = material_of(fitted.model);
  const auto stiffness_at = [&](std::size_t p) { return fitted.about.at(p, material); };
  const Eigen::VectorXd f = model_forces(fitted.model, whole, stiffness_at, all, false).f;
  const Eigen::VectorXd left = measured_forces(whole, all) - f;
  LaterError error;
  std::vector<double> share;
  double squares = 0;
  Eigen::Index at = 0;
  for (const Episode& e : whole.episodes) {
    double peak = 0;
    for (const int row : e.rows) peak = std::max(peak, whole.recording.f[row].norm());
    for (std::size_t i = 0; i < e.rows.size(); ++i, at += 3) {
      if (e.view.t[i] <= seconds) continue;
      const double size = left.segment<3>(at).norm();
      squares += size * size;
      if (peak > 0) share.push_back(size / peak);
      ++error.rows;
    }
  }
  error.rmse = std::sqrt(squares / std::max(1.0, whole.axes() * static_cast<double>(error.rows)));
  error.median = upper_median(std::move(share));
  return error;
}

}  // namespace hapsim
