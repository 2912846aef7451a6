// Volumes of voxels, as CT and MR give them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "io/stream.h"

namespace hapsim {

// Memory: 4 bytes a voxel, and while it is read the file's bytes beside it (unpacked).
struct Volume {
  std::array<int, 3> size{0, 0, 0};                        // at least 2 each
  std::vector<float> values;                               // values[i + size[0] (j + size[1] k)]
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();  // voxel centre (i, j, k) to [m]
  std::string format;                                      // "NRRD, gzip", for people
  std::vector<std::string> notes;

  std::size_t count() const { return values.size(); }
  float at(int i, int j, int k) const {
    return values[static_cast<std::size_t>(i) +
                  static_cast<std::size_t>(size[0]) *
                      (static_cast<std::size_t>(j) +
                       static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k))];
  }
};

// Whether the first bytes (400 are enough) are those of a volume that read_volume knows.
bool looks_like_volume(const std::string& bytes);

// NRRD (raw, gzip, ascii, hex, header and data in one file) or NIfTI-1 and -2 (.nii, .nii.gz), by
// content. Spacing, origin and direction as the file states them, in its own frame (NIfTI: right,
// anterior, superior), millimetres where it states no unit. Error(kBadInput, name): truncated, a
// size that the bytes cannot hold, not three-dimensional, no numbers, a singular direction.
Volume read_volume(const std::string& bytes, const std::string& name);

// The slices of a DICOM folder as one volume in the patient's frame (left, posterior, superior);
// of several series the one with most slices. Rescale slope and intercept are applied. Error:
// no image in it, slices of unequal size or distance (named).
Volume read_dicom_series(const std::string& folder);

// The readers behind read_volume.
Volume read_nrrd(const std::string& bytes, const std::string& name);
Volume read_nifti(const std::string& bytes, const std::string& name);

// Checks what a header claims before anything is allocated, and allocates. `bytes_a_voxel` times
// the voxels must not exceed `available` bytes.
void allocate_volume(Volume& volume, const std::array<long long, 3>& size, double bytes_a_voxel,
                     double available, const std::string& name);
void check_world(const Volume& volume, const std::string& name);

// Threshold between two classes by Otsu's method (1979): the largest variance between classes of a
// histogram of 256 bins from the least value to the largest.
struct ValueRange {
  double least = 0, largest = 0, otsu = 0;
};
ValueRange value_range(const Volume& volume);

// Error(kUsage) that says the range of values and what --threshold may be.
[[noreturn]] void fail_no_threshold(const Volume& volume, const std::string& name);

}  // namespace hapsim
