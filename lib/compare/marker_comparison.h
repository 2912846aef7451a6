// Measured displacements of marked points against simulated ones.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/marker_table.h"

namespace hapsim {

struct MarkerComparison {
  std::size_t rows = 0;     // that both tables have
  std::size_t missing = 0;  // measured ones that the simulated table lacks
  double rms = 0;           // of a component of measured less simulated displacements [m]
  double size = 0;          // of a measured component [m]
  double noise = 0;         // of a component [m]
  std::string noise_origin;
  double mesh = 0;  // what the meshes of the simulated ones leave open [m]; 0: not known
  struct OfPoint {
    std::string name;
    std::size_t rows = 0;
    double rms = 0;  // [m]
  };
  std::vector<OfPoint> points;  // the worst first
};

// Rows of both are the same where point, press and time (to a nanosecond) are. Noise is declared
// (marker_noise), else measured as that of forces is (recording/force_noise.h).
// Error(kBadInput): no row in common; a point that lies elsewhere at rest.
MarkerComparison compare_markers(const MarkerTable& measured, const MarkerTable& simulated);

// No more is left than noise, and what the meshes leave open.
bool markers_explained(const MarkerComparison& markers);
// Lines for people.
std::vector<std::string> marker_facts(const MarkerComparison& markers);

}  // namespace hapsim
