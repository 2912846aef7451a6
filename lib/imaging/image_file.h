// A stiffness image as a file: a table, or the body with its moduli for ParaView and the like.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// By the end of the name, whatever its case: .vtu, .ply, else CSV.
enum class ImageFormat { kCsv, kPly, kVtu };
ImageFormat image_format(const std::string& path);

// `modulus`: E [Pa] of each tetrahedron. CSV: x,y,z,E of the centres, in the body's order. PLY and
// VTU: the body itself, with the property (cell data) E of its tetrahedra.
void write_image(std::ostream& out, const TetMesh& body, const std::vector<double>& modulus,
                 ImageFormat format);

}  // namespace hapsim
