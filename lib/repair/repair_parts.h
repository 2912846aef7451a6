// The steps of repair_surface().
#pragma once

#include <array>
#include <cstddef>

#include "repair/repair.h"

namespace hapsim {

// Triangles alone: what lies at one place merged, what has no area or is given twice dropped, sides
// split where a vertex lies on them, all turned alike and outward.
Surface repair_soup(const Surface& given, RepairReport& report);

// Vertices and edges at which surfaces only touch, or more than two triangles meet, taken apart: a
// manifold, perhaps with open edges. Returns the number of new vertices.
int take_apart(Surface& surface);

// Closes every ring of open edges; Error(kBadInput, name) with its place when one cannot be closed.
void close_holes(Surface& surface, const std::string& name, RepairReport& report);

// Pairs of triangles that cut each other; the first of them, when there are any, into `first`.
std::size_t count_cuts(const Surface& surface, std::array<int, 2>& first);
// Replaces what cuts itself by new triangles about it; false when that did not help.
bool remove_cuts(Surface& surface);

// Whether two closed surfaces cut each other, and the surface about both; false: it cannot be made.
bool parts_cut(const Surface& one, const Surface& other);
bool join_parts(const Surface& one, const Surface& other, Surface& joined);

}  // namespace hapsim
