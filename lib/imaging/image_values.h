// A stiffness image on the tetrahedra of a body.
#pragma once

#include <vector>

#include "imaging/stiffness_image.h"
#include "mesh/tetmesh.h"

namespace hapsim {

// One value a tetrahedron, of its middle.
struct ImageValues {
  double model_modulus = 0;     // E of the model that the image is about [Pa]
  std::vector<double> modulus;  // E [Pa]
  std::vector<double> log_std;  // standard error of log E
  // Over which distance about it E is an average [m], at most the body's diagonal.
  std::vector<double> resolution;
};

// The modulus over the model's at a point: the lumps', or where none was found the field's.
double modulus_ratio(const StiffnessImage& image, const Vec3& p);

// Standard error of the log of that ratio: of the field (image_field.h), between the grid's nodes
// not less than that of their mean and outside of the grid the largest of all; and of what the
// draws of a lump's posterior differ by from the lump that was drawn, square by square.
double log_std_error(const StiffnessImage& image, const Vec3& p);

// On a body whose model has the one `modulus` [Pa].
ImageValues image_values(const StiffnessImage& image, const TetMesh& body, double modulus);

}  // namespace hapsim
