// Two regions from what modulus each contact position asks for, the boundary between them where the
// body's stiffness says that it lies.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cluster/class_boundary.h"
#include "contact/contact_stiffness.h"
#include "regions/locations.h"

namespace hapsim {

// Difference of the criterion from which more regions, or a boundary that is not straight, are
// believed: strong evidence (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995).
constexpr double kStrongEvidence = 6;

struct RegionBoundary {
  PlaneClassifier side;  // 0 or 1 of a plan position
  double log_gain[2];    // of the modulus on either side, over the model's; the second is larger
  int keys = 8;          // points that draw it
  double criterion = 0;  // squares over the samples' errors, and log n for each parameter
};

// A straight, a bent or a round boundary through the whole depth, or any smooth curve
// (find_curve()) where that explains more. A position near it feels both
// sides: log E there is the mean of theirs weighted by the strain energy that a homogeneous body
// has on either side (`share`, by sample and cell of `grid`; first order in the contrast), which
// one modulus a position cannot say. Nothing for fewer samples than a boundary has parameters and
// one more.
std::optional<RegionBoundary> find_boundary(const std::vector<LocationSample>& samples,
                                            const std::vector<std::vector<float>>& share,
                                            const PlanGrid& grid);

}  // namespace hapsim
