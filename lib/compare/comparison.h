// A whole comparison of a measured recording with simulated forces, ready to be shown.
#pragma once

#include <string>
#include <vector>

#include "compare/marker_comparison.h"
#include "compare/structure.h"
#include "compare/torque_comparison.h"

namespace hapsim {

struct Comparison {
  ErrorSize size;
  NoiseLevel noise;
  double mesh = 0;  // what the meshes of the simulated forces leave open [N]; 0: not known
  RowFacts facts;
  std::vector<Breakdown> breakdowns;  // the first is by position
  std::vector<Observation> observations;
  TorqueComparison torque;
  std::optional<MarkerComparison> markers;  // where points were given, by whoever has their tables

  const Breakdown& by_position() const { return breakdowns.front(); }
  std::vector<int> worst_positions() const;  // bins of by_position(), largest rmse first
};

// Checks that the two match (check_match) and compares them.
Comparison compare(const Recording& measured, const Recording& simulated);

// The measured recording with its residuals, of torques too where they were compared.
Recording residuals_of(const Comparison& comparison, const Recording& measured,
                       const Recording& simulated);

// The comparison as JSON text (two spaces of indent, a newline at the end): rows, presses, rmse,
// rmse_axes, force_rms, force_peak, noise, noise_source, observations, breakdowns; where torques
// were compared torque_rmse, torque_rms and torque_noise [N m]; of marked points marker_rmse,
// marker_rms, marker_noise [m] and marker_points. NaN becomes null.
std::string comparison_json(const Comparison& comparison, const std::string& measured_name,
                            const std::string& simulated_name);

}  // namespace hapsim
