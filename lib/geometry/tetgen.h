// Tetrahedra inside a closed surface, by TetGen (Si, ACM Trans. Math. Softw. 41(2), 2015).
#pragma once

#include <string>
#include <vector>

#include "geometry/tetmesh.h"

namespace hapsim {

struct TetgenInput {
  Surface surface;                // closed, outward, one part
  std::vector<int> face_marker;   // one a face, positive; empty: 1 everywhere
  std::vector<Vec3> seeds;        // further nodes inside, not on the surface
  std::vector<double> node_size;  // wished edge length at the surface's vertices [m]; or empty
};

struct TetgenOptions {
  double radius_edge = 1.4;      // bound of circumradius over shortest edge; 1.1 or more, 0: none
  double min_dihedral = 0;       // [deg], wished; 0 to 18
  double max_volume = 0;         // of one tetrahedron [m^3]; 0: no bound
  bool preserve_surface = true;  // no new node on the surface
  double time_limit = 120;       // [s]
};

struct TetgenResult {
  TetMesh mesh;  // order 1, region 0, nothing fixed; the surface's vertices come first
  std::vector<int> face_marker;  // one a boundary face of the mesh: that of the face it lies on
};

// Runs TetGen in a forked child, for it crashes or hangs on what it cannot mesh; safe in a process
// of several threads. Same input, same mesh. Error(kBadInput) beginning with `where` when the input
// fails check_surface() or TetGen crashes, finds nothing or runs out of time; it names the place
// where the surface intersects itself if it does.
TetgenResult run_tetgen(const TetgenInput& input, const TetgenOptions& options,
                        const std::string& where = "");

// What can be told without geometry search: indices, finite coordinates, no doubled vertex, no flat
// triangle, every edge with two faces, one part, outward, not flat. Error(kBadInput) naming the
// place and what to do.
void check_surface(const Surface& surface, const std::string& where);
// Error(kBadInput) naming the first pair of triangles that cut each other.
void check_self_intersection(const Surface& surface, const std::string& where);

}  // namespace hapsim
