// The fit of an analytical model on a screen.
#pragma once

#include <fmt/format.h>

#include "acfm/acfm_record.h"
#include "cli/summary.h"

namespace hapsim {

inline Summary acfm_summary(const AcfmFit& fit, const Dataset& dataset, const Noise& noise) {
  constexpr double kNoiseAlone = 1.15;
  Summary s;
  s.mark = fit.rmse <= kNoiseAlone * noise.value ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict = fmt::format("{}: springs and dashpots at {} position{}", dataset.recording.name,
                          dataset.positions.size(), dataset.positions.size() == 1 ? "" : "s");
  s.size = fmt::format("error {:.4g} N", fit.rmse);
  s.items = {{"FIT", "", "", fit_lines(fit, dataset, noise)}};
  s.values = {{"error", fit.rmse, "N"},
              {"heldout_presses", fit.held_out_presses, "N"},
              {"heldout_positions", fit.held_out_positions, "N"},
              {"force_noise", noise.value, "N"},
              {"positions", static_cast<double>(dataset.positions.size()), "1"}};
  return s;
}

}  // namespace hapsim
