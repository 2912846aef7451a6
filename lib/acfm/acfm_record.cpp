#include "acfm/acfm_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/fitted_range.h"
#include "io/number.h"

namespace hapsim {

void record_fit(AcfmFit& fit, const Dataset& dataset, const Noise& noise) {
  Metadata& metadata = fit.model.metadata;
  metadata.set("tool_radius", format_number(dataset.recording.tool_radius()));
  metadata.set("force_noise", format_number(noise.value));
  metadata.set("rmse", format_number(fit.rmse));
  record_range(dataset, metadata);
  if (!std::isnan(fit.held_out_presses))
    metadata.set("heldout_presses", format_number(fit.held_out_presses));
  if (!std::isnan(fit.held_out_positions))
    metadata.set("heldout_positions", format_number(fit.held_out_positions));
}

std::vector<std::string> fit_lines(const AcfmFit& fit, const Dataset& dataset, const Noise& noise) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& text) { lines.push_back(text); };
  double squares = 0;
  for (const Vec3& f : dataset.recording.f) squares += f.squaredNorm();
  const double force = std::sqrt(squares / (3 * static_cast<double>(dataset.rows())));
  const auto error = [&](double value) {
    return fmt::format("{:.4g} N = {:.3g} % of the force's rms, {:.3g} x noise", value,
                       100 * value / force, value / noise.value);
  };
  line(fmt::format(
      "{} sub-models of {} Maxwell elements a direction from {} samples; noise {:.3g} "
      "N ({})",
      dataset.positions.size(), fit.model.terms, dataset.rows(), noise.value, noise.origin));
  if (fit.derived_axes > 0)
    line(
        fmt::format("{} of {} directions are not moved in these data: taken from the others by "
                    "the ratio of a bonded disc",
                    fit.derived_axes, 3 * dataset.positions.size()));
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, fit.remarks.size()); ++i) line(fit.remarks[i]);
  if (fit.remarks.size() > kMost) line(fmt::format("... and {} more", fit.remarks.size() - kMost));
  line("error " + error(fit.rmse));
  if (!std::isnan(fit.held_out_presses))
    line("on presses not seen by the fit " + error(fit.held_out_presses));
  if (!std::isnan(fit.held_out_positions))
    line("at positions interpolated from the others " + error(fit.held_out_positions));
  return lines;
}

}  // namespace hapsim
