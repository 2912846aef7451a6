// Sharp edges, which a smooth reconstruction rounds, back into a surface.
#pragma once

#include <limits>
#include <vector>

#include "mesh/surface.h"
#include "reconstruct/patches.h"

namespace hapsim {

// A surface whose faces name the patch they belong to; the flat bottom has the label `bottom`.
struct LabelledSurface {
  static constexpr int kBottom = -1;
  static constexpr int kFree = -2;  // no patch is nearby: stays as it is
  Surface surface;
  std::vector<int> label;  // as many as faces
};

struct CreaseOptions {
  double edge = 0;                                         // edge length of the surface [m]
  double spacing = 0;                                      // distance of neighbouring points [m]
  double base = std::numeric_limits<double>::quiet_NaN();  // height of the flat bottom [m]
};

// Gives each vertex to the patch nearby whose surface it lies nearest to, and cuts the faces
// between vertices of different patches: the seams run where two patches meet, their forks where
// three do.
LabelledSurface cut_along_patches(const Surface& surface, const Segmentation& segmentation,
                                  const CreaseOptions& options);

// Moves every vertex onto the surfaces of all the patches about it (Newton steps to where their
// heights vanish), those of the bottom within it; none farther than two edges, and none so that a
// face turns over. Returns the number of faces that look away from their patch.
int project_to_patches(LabelledSurface& labelled, const Segmentation& segmentation,
                       const CreaseOptions& options);

}  // namespace hapsim
