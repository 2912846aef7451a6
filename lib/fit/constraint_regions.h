// Regions of constraints by their names, or by a point of theirs.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// The names of regions 0, 1, ... that a text lists ("liver, tumour"). Error(kUsage) beginning with
// `option`: a name is no word of letters, digits and _ that begins with a letter, or stands twice.
std::vector<std::string> region_names(const std::string& text, const std::string& option);

// E[tumour] and E[0.02,0.025,0.01] as E of that region's number: by the model's metadata
// `region_names`, and by the place: the nearest key point's region in plan view where the model
// divides the body so, else that of the body's tetrahedron at the point (three coordinates [m]).
// The texts stay. Error(kUsage): no such name, nothing of the body at the point, or a layer or an
// inclusion, of which regions say nothing.
std::vector<Relation> number_regions(const std::vector<Relation>& constraints, const Model& model,
                                     const TetMesh& body);

}  // namespace hapsim
