// What a comparison's report draws: forces of presses, and residuals against one quantity.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "report/report.h"

namespace hapsim {

// A simulated recording under the name it is shown by.
struct SimulatedVersion {
  std::string name;
  Recording recording;
};

// Residuals along the normal of the position against depth, speed, time since contact and time in
// the session, as far as the recording has them: evenly thinned rows, and the means of twelve
// groups with their standard errors (binned_trend()).
void add_residual_plots(const Recording& measured, const Recording& simulated,
                        const Comparison& comparison, Report& report);

// Measured and simulated forces of the 2000 presses with the largest rmse of the last version, in
// the order of the recording; long presses thinned so that the page stays below some 400,000
// numbers (60 to 300 rows a press).
void add_presses(const Recording& measured, const std::vector<SimulatedVersion>& versions,
                 const Comparison& comparison, Report& report);

}  // namespace hapsim
