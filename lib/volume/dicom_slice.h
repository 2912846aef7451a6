// One DICOM file, read where damage can do no harm.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace hapsim {

struct DicomSlice {
  std::string file;
  std::string series;
  int columns = 0, rows = 0;
  Eigen::Vector2d spacing;  // between columns, between rows [mm]
  Eigen::Vector3d origin, along_row, along_column;
  std::vector<float> values;
};

// The images among `files`, in their order. GDCM ends the process on some damaged files, so it
// works in a child process with a time limit for each file; its pixels come back through a pipe.
// Error(kBadInput, file): damaged, several frames, colours, no place stated.
std::vector<DicomSlice> read_dicom_slices(const std::vector<std::string>& files);

// Error(kBadInput, file) that says what is wrong with a slice, and the mend.
[[noreturn]] void fail_slice(const std::string& file, const std::string& wrong);

}  // namespace hapsim
