// What hs-tetmesh is given: a closed surface, or a mesh of tetrahedra from elsewhere.
#pragma once

#include <optional>
#include <string>

#include "formats/mesh_file.h"
#include "io/stream.h"
#include "mesh/support.h"

namespace hapsim {

struct BodyInput {
  std::optional<MeshFile> mesh;  // there are tetrahedra already
  Surface surface;               // otherwise
  std::optional<Support> base;   // the bottom as "comment base_plane nx ny nz h" of a PLY tells it
};

// By content: PLY, STL or OFF as surface; PLY with tetrahedra, VTU, Gmsh, Abaqus, FEBio, SOFA or
// TetGen's files as mesh.
// Lengths are multiplied by `factor`. Error(kBadInput): none of these; points, for which it names
// the commands that make a surface of them.
BodyInput read_body_input(Input& input, double factor = 1);

// OFF, ASCII, polygons as fans; stray vertices are dropped. Error(kBadInput) with the line.
Surface parse_off(const std::string& bytes, const std::string& name);

}  // namespace hapsim
