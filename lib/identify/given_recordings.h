// What is to be fitted: recordings, each of a body pressed with a tool, as one.
#pragma once

#include <string>
#include <vector>

#include "experiment/dataset.h"
#include "fit/fit_request.h"
#include "mesh/tetmesh.h"
#include "model/model.h"

namespace hapsim {

struct GivenRecordings {
  std::vector<TetMesh> bodies;
  std::vector<std::vector<Vec3>> windows;  // of the bodies (ExperimentOptions::windows)
  std::vector<Setup> setup_of_row;         // Setup::body numbers `bodies`
  Dataset dataset;                         // all as one
};

// Error(kUsage) when there is neither one body nor one for each recording.
void require_bodies_for(std::size_t bodies, std::size_t recordings);

// Joins `recordings` and fills in the setups; `body_of`: by recording, which of `given.bodies` was
// pressed. `start`: the model that is gone on with, empty without. Error(kBadInput) for a recording
// whose presses cannot be what they claim (require_presses()), with its file's name.
void join_given(GivenRecordings& given, const std::vector<int>& body_of,
                std::vector<Recording> recordings, const Model& start);

// Refuses, before anything is prepared, what is asked of recordings of several bodies or tools and
// knows one only: the automatic search, and effects (of the start, or to be added) whose parameters
// belong to one.
void require_fit_for(const FitRequest& request, const Dataset& dataset);

}  // namespace hapsim
