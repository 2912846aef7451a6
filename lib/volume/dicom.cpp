#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "io/number.h"
#include "volume/dicom_slice.h"
#include "volume/volume.h"

namespace hapsim {
Volume read_dicom_series(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, std::vector<DicomSlice>> series;
  std::size_t strange = files.size();
  for (DicomSlice& slice : read_dicom_slices(files)) {
    series[slice.series].push_back(std::move(slice));
    --strange;
  }
  if (series.empty()) {
    fail_input(folder, "there is no DICOM image in it", "give the folder that holds the slices");
  }
  auto largest = series.begin();
  for (auto at = series.begin(); at != series.end(); ++at) {
    if (at->second.size() > largest->second.size()) largest = at;
  }
  std::vector<DicomSlice>& slices = largest->second;
  Volume volume;
  volume.format = fmt::format("DICOM, {} slices", slices.size());
  if (series.size() > 1) {
    volume.notes.push_back(fmt::format("of {} series the largest taken", series.size()));
  }
  if (strange > 0) volume.notes.push_back(fmt::format("{} files are no images", strange));

  const DicomSlice& first = slices.front();
  const Eigen::Vector3d normal = first.along_row.cross(first.along_column);
  std::sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return a.origin.dot(normal) < b.origin.dot(normal);
  });
  const double count = static_cast<double>(slices.size());
  allocate_volume(volume,
                  {slices[0].columns, slices[0].rows, static_cast<long long>(slices.size())}, 1,
                  1e300, folder);
  const Eigen::Vector3d origin = slices.front().origin;
  const Eigen::Vector3d step = (slices.back().origin - origin) / (count - 1);
  if (!(step.norm() > 1e-6)) fail_slice(slices[1].file, "two slices lie at the same place");
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const DicomSlice& s = slices[k];
    if (s.columns != slices[0].columns || s.rows != slices[0].rows ||
        (s.spacing - slices[0].spacing).norm() > 1e-4 * s.spacing.norm() ||
        (s.along_row - slices[0].along_row).norm() > 1e-3 ||
        (s.along_column - slices[0].along_column).norm() > 1e-3) {
      fail_slice(s.file, "this slice differs in size or direction from " + shown(slices[0].file));
    }
    const Eigen::Vector3d off = s.origin - origin - static_cast<double>(k) * step;
    if (off.norm() > 0.02 * step.norm()) {
      fail_slice(s.file, fmt::format("this slice lies {:.3g} mm off even distances: one is missing "
                                     "or given twice",
                                     off.norm()));
    }
    std::copy(s.values.begin(), s.values.end(),
              volume.values.begin() + static_cast<std::ptrdiff_t>(k * s.values.size()));
  }
  auto& m = volume.to_world.matrix();
  m.topRows<3>() << slices[0].along_row * slices[0].spacing[0],
      slices[0].along_column * slices[0].spacing[1], step, origin;
  m.topRows<3>() *= 1e-3;
  check_world(volume, folder);
  return volume;
}

}  // namespace hapsim
