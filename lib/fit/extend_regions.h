// A fitted model with regions, made from what modulus each contact position asks for.
#pragma once

#include "fit/extend.h"

namespace hapsim {

// Rows of E by region and of key points. With kAutomaticRegions either regions of nearest
// positions, as many as their moduli ask for, or two with a boundary (find_boundary()), by the
// information criterion.
Model with_regions(const Fit& fitted, const Experiment& experiment, const Selection& selection,
                   const ExtendOptions& options);

}  // namespace hapsim
