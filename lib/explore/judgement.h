// What is known of a body by its presses so far.
#pragma once

#include <optional>
#include <vector>

#include "explore/explore.h"
#include "explore/seen_places.h"
#include "explore/unseen.h"

namespace hapsim {

struct Judgement {
  Experiment experiment;
  Coverage coverage = {};
  std::optional<Diagnosis> diagnosis = {};  // where a goal asks for it
  bool settled = false;                     // its verdict
  std::optional<Fit> fitted = {};           // the model as it was given
  std::vector<SeenPlace> seen = {};
  LeftOut left_out = {};                     // by `seen`, where a goal asks for it
  std::optional<StiffnessImage> image = {};  // where a lump is looked for at enough places
  std::vector<GoalState> goals = {};
};

// Of kLeastPresses or more; arguments as of explore(). Error(kBadInput): a lump is asked for in a
// body of several moduli. Error(kNoConvergence): the model does not fit.
Judgement judge(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                const Recording& recording, const ExploreOptions& options);

// How deep a lump would have shown beside what was found: a verdict holds no further. None where no
// image can be made (of several moduli, of few gains).
std::optional<StiffnessImage> sight_of(const Judgement& known, const TetMesh& body,
                                       const ExploreOptions& options);

}  // namespace hapsim
