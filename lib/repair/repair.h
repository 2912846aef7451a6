// Given triangles made into the closed surface of one body.
#pragma once

#include <string>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

// What was mended; 0 everywhere for a sound surface.
struct RepairReport {
  int stray_vertices = 0;   // that no triangle used
  int welded = 0;           // vertices merged with another at the same place
  int degenerate = 0;       // triangles without area
  int duplicate = 0;        // triangles given before
  int t_junctions = 0;      // vertices on the side of a triangle, which was split there
  int flipped = 0;          // triangles that looked inward
  int split_vertices = 0;   // vertices and edges at which surfaces only touched, taken apart
  int holes = 0;            // closed
  double largest_hole = 0;  // length of its rim [m]
  Vec3 largest_hole_at = Vec3::Zero();
  int self_intersections = 0;    // pairs of triangles that cut each other
  int joined = 0;                // overlapping parts made one
  int components = 0;            // further parts, removed
  double components_volume = 0;  // theirs [m^3]
  int inner_shells = 0;          // cavities, removed
  int added_triangles = 0;       // in closed holes

  int total() const;
  // "12 vertices welded, 2 holes closed (the largest with a rim of 14 mm at (...))"; "nothing to
  // mend".
  std::string text() const;
  // {"welded": 12, ...}
  std::string json() const;
};

// In order: vertices at one place are merged; triangles without area or given twice are dropped;
// open edges that nearly meet are merged; vertices on the side of an open triangle split it; all
// are turned alike, and outward; what only touches is taken apart; overlapping parts are joined,
// others but the largest removed, as are inner shells; holes are closed (flat rims by flat
// triangles, others refined and faired); triangles that cut each other are replaced.
// A sound surface comes back as it was. Error(kBadInput, name) with the place and the mend when the
// result is not closed, manifold and free of self-intersection.
Surface repair_surface(const Surface& given, const std::string& name, RepairReport& report);

// A surface about the triangles, for what cannot be repaired: gaps up to `edge` [m] are bridged (0:
// a fiftieth of the size), all lies a thirtieth of that outside.
Surface wrap_surface(const Surface& given, double edge, const std::string& name);

// A sound surface of even triangles whose edges turned by more than 40 degrees are kept.
Surface even_surface(const Surface& surface, double edge);

// The vertices that triangles use, with the mean normal of their triangles.
PointCloud points_of_triangles(const Surface& surface);

}  // namespace hapsim
