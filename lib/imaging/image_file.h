// A stiffness image as a file: a table, or the body with its moduli for ParaView and the like.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "imaging/image_values.h"
#include "io/stream.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// By the end of the name, whatever its case: .vtu, .ply, else CSV.
enum class ImageFormat { kCsv, kPly, kVtu };
ImageFormat image_format(const std::string& path);

// E, log_E_std and resolution of each tetrahedron (image_values.h). CSV: x,y,z of the centres
// beside them, in the body's order, and the metadata model_modulus. PLY and VTU: the body itself,
// with these as properties (cell data) of its tetrahedra; a PLY has the comment model_modulus.
void write_image(std::ostream& out, const TetMesh& body, const ImageValues& values,
                 ImageFormat format);

struct ImageOnBody {
  TetMesh body;
  ImageValues values;
};

// A PLY that write_image() wrote. Error(kBadInput) with the file's name: another format, no moduli,
// none of the errors or of the model's modulus (files from before 1.0), values that are no moduli
// or no errors.
ImageOnBody read_image(Input& input);

}  // namespace hapsim
