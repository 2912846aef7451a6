// Surfaces inside a body that bound its regions: private to lib/tetmesh.
#pragma once

#include <string>
#include <vector>

#include "mesh/signed_distance.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {

struct InnerParts {
  std::vector<Surface> bounding;         // wholly inside: TetGen keeps them as faces
  std::vector<SignedDistance> distance;  // one an inner region
};

// Error(kBadInput) when an inner surface is not closed or cuts itself.
InnerParts inner_parts(const Surface& outer, const std::vector<InnerRegion>& inner,
                       const std::string& where, std::vector<std::string>& notes);

// Each tetrahedron whose centre lies in the k-th inner region gets the number k + 1; the last wins.
// Error(kBadInput) when a region has none.
void colour_regions(TetMesh& mesh, const InnerParts& parts, const std::vector<InnerRegion>& inner);

}  // namespace hapsim
