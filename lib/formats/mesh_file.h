// Meshes of tetrahedra in the formats of other programs, read by content and written.
#pragma once

#include <string>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// What was mended while reading.
struct MeshRepairs {
  std::size_t unused_nodes = 0;  // of no tetrahedron: dropped
  std::size_t turned = 0;        // inverted tetrahedra: two corners exchanged
  std::size_t doubled = 0;       // the same tetrahedron again: dropped
  std::size_t other_cells = 0;   // cells of other shape inside the volume: left out
};

struct MeshFile {
  TetMesh mesh;
  std::string format;      // "PLY", "VTU", "Gmsh 4.1", "TetGen", ...
  bool has_fixed = false;  // the file says which nodes are fixed
  MeshRepairs repairs;
};

// By content, in any format of the table (formats/format_table.h) that can hold tetrahedra; what is
// taken of each, its regions and what is fixed, stands at the head of format_NAME.cpp.
// `mend`: repair what MeshRepairs lists instead of refusing the inverted and leaving the doubled.
// Error(kBadInput) with file and line (text) or place: truncated, index out of range, flat
// tetrahedron, faces of more than two tetrahedra, middles that are not on their edges.
MeshFile parse_mesh(const std::string& bytes, const std::string& where, bool mend);

// Appended raw, or text; point data `fixed`, cell data `region`.
void write_mesh_vtu(std::ostream& out, const TetMesh& mesh, bool ascii = false);
// ASCII; `version` 22 or 41. Physical volumes region_N, surfaces `free` and `fixed`; node data
// `fixed`.
void write_mesh_gmsh(std::ostream& out, const TetMesh& mesh, int version = 22);
// Abaqus, CalculiX: C3D4 or C3D10, element sets REGION_N, node sets NALL and FIXED, surface
// BOUNDARY of the element faces.
void write_mesh_abaqus(std::ostream& out, const TetMesh& mesh);
void write_mesh_tetgen(std::ostream& node, std::ostream& ele, const TetMesh& mesh);

}  // namespace hapsim
