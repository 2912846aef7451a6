// From a closed surface to a body of tetrahedra on its support.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesh/support.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// A closed surface inside the body: its tetrahedra get the next region's number, from 1.
struct InnerRegion {
  Surface surface;
  std::string name;  // begins error messages
};

struct BodyOptions {
  double edge = 0;        // wished edge length [m]; 0: from max_volume, else about 5000 tetrahedra
  double max_volume = 0;  // of one tetrahedron [m^3]; 0: none
  double radius_edge = 1.4;
  double min_dihedral = 0;        // [deg], wished, up to 18
  bool plain = false;             // no bound at all: the constrained Delaunay mesh of the surface
  bool preserve_surface = false;  // keep the surface's triangles as they are
  int order = 1;
  Support support;
  std::vector<Vec3> contacts;  // each becomes a node, and is refined about ...
  double tool_radius = 0;      // ... within 1.5 times this [m] ...
  double contact_size = 0;     // ... to this edge length [m]; 0: half the tool's radius
  double growth = 0.5;         // edge length over distance from there on
  std::vector<InnerRegion> inner;
  Surface
      curved_to;  // second order: boundary nodes are laid on this smooth surface; empty: straight
  double time_limit = 120;          // [s]
  std::function<void()> heartbeat;  // called some times a second while TetGen runs
};

struct BodyReport {
  std::vector<int> contact_node;   // one a contact; -1: none, the surface was to be preserved
  std::vector<std::string> notes;  // what a user should know, a line each
};

// The surface is coarsened where it is finer than wished (its volume kept, the outline of the
// bonded part kept) and split where it is coarser. Inner regions that lie wholly inside bound
// tetrahedra; those that touch or cut the surface or each other only colour them, by their centres,
// and a note says so. Error(kBadInput) beginning with `where`: the surface is not closed, cuts
// itself, or no face of it is bonded where the support says so; a contact lies off the surface; an
// inner surface is not closed or lies outside.
TetMesh make_body_mesh(const Surface& surface, const BodyOptions& options,
                       const std::string& where = "", BodyReport* report = nullptr);

}  // namespace hapsim
