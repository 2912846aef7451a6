// An order of unknowns that keeps neighbours near: private to lib/linalg.
#pragma once

#include <vector>

namespace hapsim {

// Lower triangle of a symmetric pattern, the diagonal first in its column.
struct LowerPattern {
  std::vector<int> start, row;
  int size() const { return static_cast<int>(start.size()) - 1; }
};

// Breadth first from a vertex far out, neighbours by degree, all reversed (Cuthill and McKee, ACM
// '69; George, 1971). order[k]: the vertex that comes k-th.
std::vector<int> cuthill_mckee_order(const LowerPattern& pattern);

}  // namespace hapsim
