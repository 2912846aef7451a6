// A recording on its body as a diagnosis needs it.
#pragma once

#include <vector>

#include "experiment/experiment.h"

namespace hapsim {

// On the coarser meshes, for many materials are tried, and for the range of Poisson's ratio that
// the model leaves. `recording` as it was read; `window` of the body (ExperimentOptions::windows).
// Errors of require_presses() and make_experiment().
Experiment draft_experiment(const TetMesh& body, const std::vector<Vec3>& window,
                            const Model& model, Recording recording, ExperimentOptions options);

}  // namespace hapsim
