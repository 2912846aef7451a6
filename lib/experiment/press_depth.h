// How deep the presses of a recording go into their bodies.
#pragma once

#include <span>
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
  long line = 0;     // of that share, in the recording's file; 0: none goes in
};
// Error(kBadInput) with the line: a tool that comes out on the far side.
PressDepth press_depth(const TetMesh& body, const Recording& recording);
// The same of every body; Setup::body of the dataset numbers them.
PressDepth press_depth(std::span<const TetMesh> bodies, const Dataset& dataset);

// Where the tool comes out on the far side: a scan is often thinner at its edge than the body was.
struct PositionsThrough {
  std::vector<std::string> why;  // by position, with the line; "": nowhere
  PressDepth others;             // of the positions that stay
};
// Error(kBadInput) where they are more than half of the positions: then it is the unit or the body.
PositionsThrough positions_through(std::span<const TetMesh> bodies, const Dataset& dataset);

// What is said of presses beyond what the model is valid for (kValidShare, FittedRange); ""
// where there is none.
std::string beyond_depth(const PressDepth& depth, const Model& model);

}  // namespace hapsim
