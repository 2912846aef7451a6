// From location samples to regions, thesis 5.2.2 and 5.2.3 with its errata.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cluster/division.h"
#include "regions/location_file.h"

namespace hapsim {

struct RegionOptions {
  std::optional<Linkage> linkage;   // empty: the first whose cophenetic correlation suffices
  double least_correlation = 0.75;  // which suffices
  int components = 0;               // principal components to keep; 0: the parameters themselves
  bool use_nu = true;               // nu as well, where it was estimated
  int regions = 0;                  // 0: natural division
  double significance = 0.05;       // of the natural division
  std::uint64_t seed = 1;
};

// Mean of a region's samples, weighted by their errors; the standard error grows with the scatter
// that these do not explain. Replaces thesis (5.12), the plain mean.
struct RegionValue {
  double E = 0, E_std = 0;  // [Pa]; the mean is that of log E
  double nu = 0, nu_std = 0;
  int samples = 0;
};

struct RegionEstimate {
  Linkage linkage = Linkage::kAverage;
  double correlation = 0;         // cophenetic, of that linkage; NaN when all distances are equal
  Dendrogram tree;                // heights in standard errors
  std::vector<BranchTest> tests;  // of the natural division; the first is one region or more
  int joined =
      0;  // samples that the natural division left alone and that joined the nearest region
  int bordering =
      0;  // samples of a border between two regions, which joined one (border_samples.h)
  std::vector<int> label;          // region of each sample, numbered by ascending E
  std::vector<RegionValue> value;  // by region
};

// Clusters log E and nu scaled by their standard errors, not positions: thesis (5.7) mixes units.
// Error(kBadInput) when there are fewer samples than regions are asked for, Error(kUsage) for more
// components than parameters.
RegionEstimate estimate_regions(const LocationTable& table, const RegionOptions& options);

const char* linkage_name(Linkage linkage);

}  // namespace hapsim
