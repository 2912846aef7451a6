// Surfaces without stray vertices.
#pragma once

#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// Drops the vertices that no face uses (the inner nodes of a body, the stray points of a scan) and
// renumbers the faces; returns how many were dropped.
inline int drop_unused(Surface& surface) {
  std::vector<int> number(surface.vertices.size(), -1);
  for (const Triangle& f : surface.faces) {
    for (const int v : f) number[v] = 0;
  }
  int next = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    surface.vertices[next] = surface.vertices[v];
    number[v] = next++;
  }
  const int dropped = static_cast<int>(number.size()) - next;
  surface.vertices.resize(next);
  for (Triangle& f : surface.faces) {
    for (int& v : f) v = number[v];
  }
  return dropped;
}

}  // namespace hapsim
