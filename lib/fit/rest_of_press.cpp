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
  thin(cut.line);
  thin(cut.press);
  thin(cut.t);
  thin(cut.position);
  thin(cut.u);
  thin(cut.f);
  thin(cut.temp);
  thin(cut.contact);
  for (auto& column : cut.extra) thin(column);
  thin(setup_of_row);
  return cut;
}

LaterError later_error(const Model& model, const Dataset& whole, const BodyStiffness& body,
                       double seconds) {
  const Selection all = all_episodes(whole);
  const Eigen::VectorXd f = model_forces(model, whole, all, body, false).f;
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
  error.rmse = std::sqrt(
      squares / std::max(1.0, measured_axes(whole.recording.f) * static_cast<double>(error.rows)));
  error.median = upper_median(std::move(share));
  return error;
}

}  // namespace hapsim
