#include "volume/volume.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "volume/gunzip.h"

namespace hapsim {
namespace {

bool is_nifti(const std::string& bytes) {
  if (bytes.size() < 348) return false;
  const std::string one = bytes.substr(344, 4), two = bytes.substr(4, 4);
  return one == std::string("n+1\0", 4) || one == std::string("ni1\0", 4) ||
         two == std::string("n+2\0", 4) || two == std::string("ni2\0", 4);
}

}  // namespace

bool looks_like_volume(const std::string& bytes) {
  return bytes.starts_with("NRRD000") || is_gzip(bytes) || is_nifti(bytes);
}

Volume read_volume(const std::string& bytes, const std::string& name) {
  if (bytes.starts_with("NRRD000")) return read_nrrd(bytes, name);
  const bool packed = is_gzip(bytes);
  if (is_nifti(packed ? gunzip(bytes, 1024, name) : bytes)) return read_nifti(bytes, name);
  if (packed) {
    fail_input(name, "what is packed in it is no NIfTI volume", "unpack it: gzip -dc FILE | ...");
  }
  fail_input(name, "this is no volume that is known",
             "give NRRD, NIfTI or a folder of DICOM slices");
}

void allocate_volume(Volume& volume, const std::array<long long, 3>& size, double bytes_a_voxel,
                     double available, const std::string& name) {
  double voxels = 1;
  for (int k = 0; k < 3; ++k) {
    if (size[k] < 2 || size[k] > 100000) {
      fail_input(name,
                 fmt::format("the volume claims {} x {} x {} voxels", size[0], size[1], size[2]),
                 "a volume of at least 2 x 2 x 2 is needed");
    }
    voxels *= static_cast<double>(size[k]);
    volume.size[k] = static_cast<int>(size[k]);
  }
  if (voxels * bytes_a_voxel > available) {
    fail_input(name,
               fmt::format("its header claims {} x {} x {} voxels, which these bytes cannot hold",
                           size[0], size[1], size[2]),
               "the file is truncated or damaged; copy or export it again");
  }
  volume.values.resize(static_cast<std::size_t>(voxels));
}

void check_world(const Volume& volume, const std::string& name) {
  const Eigen::Matrix3d a = volume.to_world.linear();
  const double scale = a.colwise().norm().prod();
  if (!(volume.to_world.matrix().allFinite() && scale > 0 &&
        std::abs(a.determinant()) > 1e-3 * scale)) {
    fail_input(name, "its voxel axes span no space", "mend the spacing and directions it states");
  }
}

void fail_no_threshold(const Volume& volume, const std::string& name) {
  const ValueRange range = value_range(volume);
  fail_usage(fmt::format("{} is a volume with values from {:.6g} to {:.6g}", name, range.least,
                         range.largest),
             fmt::format("give its surface's: --threshold {:.4g} (by Otsu's method)", range.otsu));
}

ValueRange value_range(const Volume& volume) {
  ValueRange range{INFINITY, -INFINITY, 0};
  for (const float v : volume.values) {
    if (!std::isfinite(v)) continue;
    range.least = std::min<double>(range.least, v);
    range.largest = std::max<double>(range.largest, v);
  }
  if (!(range.largest > range.least)) return range;
  constexpr int kBins = 256;
  std::array<double, kBins> count{};
  const double width = (range.largest - range.least) / kBins;
  double total = 0, sum = 0;
  for (const float v : volume.values) {
    if (!std::isfinite(v)) continue;
    const int bin = std::min(kBins - 1, static_cast<int>((v - range.least) / width));
    ++count[static_cast<std::size_t>(bin)];
    ++total;
    sum += bin;
  }
  double below = 0, below_sum = 0, best = -1;
  for (int b = 0; b + 1 < kBins; ++b) {
    below += count[static_cast<std::size_t>(b)];
    below_sum += b * count[static_cast<std::size_t>(b)];
    if (below == 0 || below == total) continue;
    const double apart = below_sum / below - (sum - below_sum) / (total - below);
    const double between = below * (total - below) * apart * apart;
    if (between <= best * (1 + 1e-12)) continue;
    best = between;
    // Between the classes' means, so that an empty valley is met in its middle.
    range.otsu =
        range.least + width * (0.5 + (below_sum / below + (sum - below_sum) / (total - below)) / 2);
  }
  return range;
}

}  // namespace hapsim
