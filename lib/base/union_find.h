// Things joined into parts: each names another of its part, or itself.
#pragma once

#include <vector>

namespace hapsim {

// The thing that stands for v's part, where parent[v] = v; shortens the way there for the next
// call. parent[root(parent, a)] = root(parent, b) joins the parts of a and b.
inline int root(std::vector<int>& parent, int v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

}  // namespace hapsim
