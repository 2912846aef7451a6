// Tetrahedra inside a closed surface, by TetGen (Si, ACM Trans. Math. Softw. 41(2), 2015).
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

struct TetgenInput {
  Surface surface;                // closed, outward, one part
  std::vector<int> face_marker;   // one a face, positive; empty: 1 everywhere
  std::vector<Surface> inner;     // closed surfaces inside, kept as faces between tetrahedra
  std::vector<Vec3> seeds;        // further nodes inside, not on a surface
  std::vector<double> node_size;  // wished edge length at the surface's vertices [m]; or empty
};

struct TetgenOptions {
  double radius_edge = 1.4;  // bound of circumradius over shortest edge; 1.1 or more, 0: none, and
                             // no node is added but where the surface cannot be kept otherwise
  double min_dihedral = 0;   // [deg], wished; 0 to 18
  double max_volume = 0;     // of one tetrahedron [m^3]; 0: no bound
  bool preserve_surface = true;  // no new node on the surface
  double time_limit = 120;       // [s]
  bool processor_time = false;   // the limit is on the child's work, whatever else runs
  // A child that has had no processor for so long [s] waits for ever; another is tried.
  double stall = 20;
  std::function<void()> heartbeat;  // called some times a second while TetGen runs
};

struct TetgenResult {
  TetMesh mesh;  // order 1, region 0, nothing fixed; the surface's vertices come first
  std::vector<int> face_marker;  // one a boundary face of the mesh: that of the face it lies on
};

// Runs TetGen in a forked child, for it crashes or hangs on what it cannot mesh; safe in a process
// of several threads. Same input, same mesh. Error(kBadInput) beginning with `where` when the input
// fails check_surface() or TetGen crashes, finds nothing or runs out of time; it names the
// triangles that cut each other, or those that come closest, if that is the cause. The mesh is
// streamed out of the child into its place: no second copy of it is held.
TetgenResult run_tetgen(const TetgenInput& input, const TetgenOptions& options,
                        const std::string& where = "");

}  // namespace hapsim
