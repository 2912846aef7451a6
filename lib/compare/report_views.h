// What a report shows of the model itself and of what was said of its forces: the curve that was
// learned, the inside, how sure a diagnosis is, and flags of live forces.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesh/surface.h"
#include "model/model.h"
#include "recording/recording.h"
#include "report/report.h"
#include "solid/body_regions.h"

namespace hapsim {

// The curves of effects with no law, with their bands.
void add_learned_curves(const Model& model, Report& report);
// How the force at the learned places goes with depth against that of the model without what was
// learned: the middle and the range of nine in ten places.
void add_learned_places(const Model& model, Report& report);

// Three cuts through what differs most from the rest of the body, with the modulus of its regions,
// inclusions and layers; none of a body that has one alone. `labels`: of the body, where they are
// the model's regions, else null.
void add_slices(const Surface& surface, const Model& model, const BodyRegions* labels,
                Report& report);

// The chance of a false alarm of each effect that the last diagnosis tried, the smallest first.
void add_chances(Report& report);

// Of columns of flags: each bit with what it says of the force in its row.
using FlagMeanings = std::map<std::string, std::vector<std::pair<int, std::string>>>;

// How often a recording of live forces has each flag.
void add_flags(const Recording& recording, const FlagMeanings& meanings, Report& report);

}  // namespace hapsim
