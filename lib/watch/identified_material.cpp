#include "watch/identified_material.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "effects/catalogue.h"
#include "io/number.h"
#include "model/body_parameters.h"

namespace hapsim {

std::vector<double> parse_relaxation_times(const std::vector<std::string>& texts,
                                           const std::string& option) {
  std::vector<double> times;
  for (const std::string& text : texts) {
    double tau = 0;
    if (!parse_number(text, tau) || !(tau > 0) || times.size() + 1 >= kMostUnknowns)
      fail_usage(option + " " + shown(text) + " is no relaxation time, or one too many",
                 "give at most five [s]: 0.05,0.5");
    times.push_back(tau);
  }
  return times;
}

Model unit_model(double nu) {
  Model unit;
  unit.parameters = body_rows(1, nu);
  return unit;
}

Model identified_model(const OnlineEstimate& found, const std::vector<double>& times, double nu) {
  Model model;
  const auto add = [&](const Effect& effect, const std::vector<double>& values, int terms) {
    const auto rows = effect_rows(effect, terms, values);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  };
  add(body_effect(), {found.moduli[0], nu}, 1);
  model.parameters[0].std_error = found.error[0];
  model.parameters[1].state = ParameterState::kFixed;
  if (!times.empty()) {
    std::vector<double> values;
    for (std::size_t i = 0; i < times.size(); ++i)
      values.insert(values.end(), {found.moduli[static_cast<Eigen::Index>(i + 1)], times[i]});
    add(maxwell_effect(), values, static_cast<int>(times.size()));
  }
  model.metadata.set("rmse", format_number(found.rmse));
  return model;
}

std::string moduli_words(const OnlineEstimate& found, const std::vector<double>& times,
                         int digits) {
  std::string words = fmt::format("E = {:.4g} Pa", found.moduli[0]);
  if (std::isfinite(found.error[0])) words += fmt::format(" ± {:.2g}", found.error[0]);
  for (std::size_t i = 0; i < times.size(); ++i)
    words += fmt::format(", {:.{}g} Pa at {:g} s", found.moduli[static_cast<Eigen::Index>(i + 1)],
                         digits, times[i]);
  return words;
}

std::vector<std::string> estimate_columns(std::size_t relaxation_times) {
  std::vector<std::string> header{"t", "rows", "E", "E_std"};
  for (std::size_t i = 1; i <= relaxation_times; ++i)
    header.insert(header.end(), {fmt::format("E{}", i), fmt::format("E{}_std", i)});
  header.push_back("rmse");
  return header;
}

std::vector<std::string> estimate_row(double t, long rows, const OnlineEstimate& e) {
  std::vector<std::string> row{format_number(t), std::to_string(rows)};
  for (Eigen::Index i = 0; i < e.moduli.size(); ++i) {
    row.push_back(fmt::format("{:.6g}", e.moduli[i]));
    row.push_back(std::isfinite(e.error[i]) ? fmt::format("{:.3g}", e.error[i]) : "");
  }
  row.push_back(std::isfinite(e.rmse) ? fmt::format("{:.4g}", e.rmse) : "");
  return row;
}

}  // namespace hapsim
