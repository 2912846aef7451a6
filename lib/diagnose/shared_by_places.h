// Effects that all places share, where what is left says that the places differ.
#pragma once

#include <vector>

#include "diagnose/candidate.h"

namespace hapsim {

// A sensor that is wrong is wrong alike at all places. Where the model with all that is missing
// leaves a stiffness that differs by place, or anything beside one that it has, and there are too
// few places to learn it from, a stiffness and a law of the depth of each place's own may have been
// all that such an effect stood for. Those of which nothing remains beside them (PlaceFreedom) are
// possible at most, and leave `base`. True when there were any.
bool doubt_what_places_share(Baseline& base, const TrialGround& ground, const Folds& folds,
                             const Gates& gates, std::vector<Finding>& findings);

}  // namespace hapsim
