// Two regions with a smooth curve between them, moved until the forces fit.
#pragma once

#include <optional>

#include "fit/boundary_fit.h"

namespace hapsim {

// `start` with its regions replaced by two along such a curve, where the positions' own moduli ask
// for no more than that: the regions of `start` are two, or more that explain them no better. None
// where they ask for more, or where nothing has come of it.
std::optional<BoundaryFit> fit_as_curve(const Fit& start, const Experiment& experiment,
                                        const TetMesh& mesh, const BoundaryOptions& options);

}  // namespace hapsim
