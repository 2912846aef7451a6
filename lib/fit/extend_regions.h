// A fitted model with regions, made from what modulus each contact position asks for.
#pragma once

#include "fit/extend.h"

namespace hapsim {

// Rows of E by region and of key points. With kAutomaticRegions either regions of nearest
// positions, as many as their moduli ask for, or two with a boundary (find_boundary()), by the
// information criterion; more than two must be better by kStrongEvidence. With kByLabel rows of E
// alone, of each number that the bodies' tetrahedra have: Error(kBadInput) where all have 0.
Model with_regions(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                   const ExtendOptions& options);

// One E a region, given by its logarithm over the fitted one.
Model with_moduli(const Model& fitted, const std::vector<double>& log_gain);

}  // namespace hapsim
