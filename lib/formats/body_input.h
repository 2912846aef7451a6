// What is given as a body's shape: a closed surface, or a mesh of tetrahedra from elsewhere.
#pragma once

#include <optional>
#include <string>

#include "formats/mesh_file.h"
#include "io/stream.h"
#include "mesh/support.h"
#include "mesh/window.h"

namespace hapsim {

struct BodyInput {
  std::optional<MeshFile> mesh;  // there are tetrahedra already
  Surface surface;               // otherwise
  std::vector<Vec3> window;      // "comment window" of a PLY (mesh/window.h)
  std::optional<Support> base;   // the bottom as "comment base_plane nx ny nz h" of a PLY tells it
};

// By content, in any format that holds triangles or tetrahedra (formats/format_table.h).
// Lengths are multiplied by `factor`. Error(kBadInput): neither; points, for which it names
// the commands that make a surface of them.
BodyInput read_body_input(Input& input, double factor = 1);

// Error(kBadInput) beginning with `where`: coordinates beyond 10 m, as of millimetres that were
// taken for metres.
void require_metres(const BodyInput& body, const std::string& where);

// Parts of the support that are the lowest plane lie on the body's own bottom instead, where its
// file tells that.
void put_on_base(Support& support, const BodyInput& body);

// What was dropped or turned while reading, in a sentence; "" where nothing was.
std::string mended_words(const MeshRepairs& repairs);

// The surface, or the boundary of the mesh, which need not be held; `mesh`, where not null, becomes
// that mesh. Errors as above.
Surface read_outside(Input& input, std::optional<TetMesh>* mesh = nullptr);

}  // namespace hapsim
