// Location samples: what modulus each contact position asks for by itself.
#pragma once

#include <vector>

#include "experiment/forces.h"

namespace hapsim {

struct LocationSample {
  int position = 0;
  Vec3 point = Vec3::Zero();  // [m]
  double gain = 1;            // modulus there over the model's modulus
  double error = 0;           // standard error of the gain
};

// One gain a position, by regression of the measured on the model's force with the sensor's effects
// kept; all other parameters as they are (thesis 5.2.1). The error has the residual's size at that
// position and the gain error of mesh and geometry.
std::vector<LocationSample> location_samples(const Model& model, const Experiment& experiment,
                                             const Linearisation& about, const Selection& selection,
                                             const Allowance& allowance);

// Samples of one place (by several tools) as one: the weighted mean of their log gains.
std::vector<LocationSample> merged_places(const std::vector<LocationSample>& samples);

// How the samples fall into regions: the number that the samples ask for (2 to `most`) by the
// information criterion, or each position by itself.
struct RegionLabels {
  std::vector<int> label;  // region of each sample
  // Squares over the samples' errors, and 2 log n a region (a modulus and a boundary each).
  double criterion = 0;
};
RegionLabels region_labels(const std::vector<LocationSample>& samples, int count, int most);
// The criterion of such labels that are given.
double labels_criterion(const std::vector<LocationSample>& samples, const std::vector<int>& label);
constexpr int kAutomaticRegions = 0;
constexpr int kEverySite = -1;
constexpr int kByLabel = -2;  // those of the body's numbered tetrahedra

}  // namespace hapsim
