#include <nifti/nifti2_io.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "base/error.h"
#include "volume/gunzip.h"
#include "volume/volume.h"

namespace hapsim {
namespace {

struct Free {
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};
using Image = std::unique_ptr<nifti_image, Free>;

double bytes_of(int type, const std::string& name) {
  switch (type) {
    case DT_UINT8:
    case DT_INT8:
      return 1;
    case DT_INT16:
    case DT_UINT16:
      return 2;
    case DT_INT32:
    case DT_UINT32:
    case DT_FLOAT32:
      return 4;
    case DT_FLOAT64:
    case DT_INT64:
    case DT_UINT64:
      return 8;
    default:
      fail_input(name, "its voxels are no plain numbers (NIfTI type " + std::to_string(type) + ")",
                 "convert them to float");
  }
}

// The library prints what it finds wrong in a header: it is asked only about headers that pass.
template <class Header, class Swap>
Header checked_header(const std::string& bytes, int size, Swap swap, const std::string& name) {
  Header header;
  if (bytes.size() < sizeof header) fail_input(name, "the header is truncated", "copy it again");
  std::memcpy(&header, bytes.data(), sizeof header);
  Header right = header;
  if (right.sizeof_hdr != size) swap(&right);
  if (right.sizeof_hdr != size) {
    fail_input(name, "its NIfTI header states a wrong length", "export it again");
  }
  bool good = right.dim[0] >= 1 && right.dim[0] <= 7;
  for (int k = 1; good && k <= right.dim[0]; ++k) good = right.dim[k] > 0;
  if (!good) fail_input(name, "its NIfTI header states no dimensions", "export it again");
  for (int k = 4; k <= right.dim[0]; ++k) {
    if (right.dim[k] != 1) {
      fail_input(name, "it holds several volumes (time or channels)", "extract one of them");
    }
  }
  if (right.dim[0] < 3) fail_input(name, "it is no volume but an image", "give all slices");
  bytes_of(right.datatype, name);
  if (std::string(right.magic, 2) == "ni") {
    fail_input(name, "header and voxels are in two files", "convert the pair to one .nii");
  }
  return header;
}

template <class T>
void convert(const char* from, std::vector<float>& to, double slope, double intercept) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    T value;
    std::memcpy(&value, from + i * sizeof(T), sizeof(T));
    to[i] = static_cast<float>(static_cast<double>(value) * slope + intercept);
  }
}

void convert(int type, const char* from, std::vector<float>& to, double slope, double intercept) {
  switch (type) {
    case DT_UINT8:
      return convert<std::uint8_t>(from, to, slope, intercept);
    case DT_INT8:
      return convert<std::int8_t>(from, to, slope, intercept);
    case DT_INT16:
      return convert<std::int16_t>(from, to, slope, intercept);
    case DT_UINT16:
      return convert<std::uint16_t>(from, to, slope, intercept);
    case DT_INT32:
      return convert<std::int32_t>(from, to, slope, intercept);
    case DT_UINT32:
      return convert<std::uint32_t>(from, to, slope, intercept);
    case DT_INT64:
      return convert<std::int64_t>(from, to, slope, intercept);
    case DT_UINT64:
      return convert<std::uint64_t>(from, to, slope, intercept);
    case DT_FLOAT32:
      return convert<float>(from, to, slope, intercept);
    default:
      return convert<double>(from, to, slope, intercept);
  }
}

Image interpret(const std::string& head, const std::string& name) {
  nifti_set_debug_level(0);
  const bool two = head.size() >= 8 && head[4] == 'n' && head[6] == '2';
  // A path is asked for by its form only: voxels are taken from memory.
  if (two) {
    const auto header = checked_header<nifti_2_header>(head, 540, nifti_swap_as_nifti2, name);
    return Image(nifti_convert_n2hdr2nim(header, "volume.nii"));
  }
  const auto header = checked_header<nifti_1_header>(head, 348, nifti_swap_as_nifti1, name);
  return Image(nifti_convert_n1hdr2nim(header, "volume.nii"));
}

}  // namespace

Volume read_nifti(const std::string& bytes, const std::string& name) {
  const bool packed = is_gzip(bytes);
  const std::string head = packed ? gunzip(bytes, 1024, name) : bytes.substr(0, 1024);
  const Image image = interpret(head, name);
  if (!image) fail_input(name, "its NIfTI header cannot be used", "export it again");
  Volume volume;
  volume.format = packed ? "NIfTI, gzip" : "NIfTI";
  const double voxel = bytes_of(image->datatype, name);
  const double offset = static_cast<double>(image->iname_offset);
  const double holds = static_cast<double>(bytes.size()) * (packed ? kMostGzipRatio : 1);
  if (!(offset >= 348 && offset <= holds)) {
    fail_input(name, "its voxels would begin outside the file", "export it again");
  }
  allocate_volume(volume, {image->nx, image->ny, image->nz}, voxel, holds - offset, name);
  const std::size_t begin = static_cast<std::size_t>(offset);
  const std::size_t length = volume.count() * static_cast<std::size_t>(voxel);
  std::string data = packed ? gunzip(bytes, begin + length, name) : bytes;
  if (data.size() < begin + length) {
    fail_input(name, "the voxels are truncated", "copy or export it again");
  }
  if (image->byteorder != nifti_short_order() && voxel > 1) {
    nifti_swap_Nbytes(static_cast<std::int64_t>(volume.count()), static_cast<int>(voxel),
                      data.data() + begin);
  }
  const bool scaled = std::isfinite(image->scl_slope) && image->scl_slope != 0;
  convert(image->datatype, data.data() + begin, volume.values, scaled ? image->scl_slope : 1,
          scaled && std::isfinite(image->scl_inter) ? image->scl_inter : 0);

  double unit = 1e-3;
  if (image->xyz_units == NIFTI_UNITS_METER) unit = 1;
  if (image->xyz_units == NIFTI_UNITS_MICRON) unit = 1e-6;
  if (image->xyz_units == NIFTI_UNITS_UNKNOWN)
    volume.notes.push_back("no unit stated, taken for mm");
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      double m = r == c ? std::abs(image->pixdim[r + 1]) : 0;
      if (image->qform_code > 0) m = image->qto_xyz.m[r][c];
      if (image->sform_code > 0) m = image->sto_xyz.m[r][c];
      volume.to_world.matrix()(r, c) = unit * m;
    }
  }
  check_world(volume, name);
  return volume;
}

}  // namespace hapsim
