// How deep the presses of a recording go into their bodies.
#pragma once

#include <string>
#include <vector>

#include "experiment/dataset.h"
#include "mesh/tetmesh.h"
#include "mesh/way_through.h"
#include "model/model.h"

namespace hapsim {

// Of the rows in contact; the deepest of each.
struct PressDepth {
  double depth = 0;  // into the surface, along its normal [m]
  double share = 0;  // of the way through the body (WayThrough)
  int row = -1;      // of that share, in the recording; -1: none goes in
};
// Error(kBadInput) with the line: a tool that comes out on the far side.
PressDepth press_depth(const TetMesh& body, const Recording& recording);
// The same of every body; Setup::body of the dataset numbers them.
PressDepth press_depth(const std::vector<TetMesh>& bodies, const Dataset& dataset);

// The deepest displacement that the model was fitted to, which hs-identify writes down [m];
// infinite where it does not say.
double fitted_depth(const Model& model);

// What is said of presses beyond what the model is valid for (kValidShare, fitted_depth()); ""
// where there is none.
std::string beyond_depth(const PressDepth& depth, const Model& model, const Recording& recording);

}  // namespace hapsim
