// Volume files written by the libraries of their formats, for tests of reading them.
#pragma once

#include <string>

#include "base/vec3.h"
#include "volume/volume.h"

namespace hapsim::test {

// Voxel values are rounded to 16 bits; the volume's frame is written in millimetres.
void write_nrrd(const Volume& volume, const std::string& path, const std::string& encoding);
void write_nifti(const Volume& volume, const std::string& path);  // .nii or .nii.gz
void write_dicom(const Volume& volume, const std::string& folder, const std::string& series,
                 double slope, double intercept);

// A ball of value 1000 in 0, blurred by a Gaussian of kBlur as a scanner does (closed form of the
// convolution), in voxels of 0.8 x 0.9 x 1.4 mm that are turned about a skew axis.
constexpr double kBlur = 0.7e-3;
Volume ball_volume(double radius, const Vec3& centre);

}  // namespace hapsim::test
