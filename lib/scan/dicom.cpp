#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmDirectory.h>
#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include "base/error.h"
#include "io/number.h"
#include "scan/volume.h"

namespace hapsim {
namespace {

struct Slice {
  std::string file;
  int columns = 0, rows = 0;
  Eigen::Vector2d spacing;  // between columns, between rows [mm]
  Eigen::Vector3d origin, along_row, along_column;
  std::vector<float> values;
};

template <class T>
void convert(const std::vector<char>& from, double slope, double intercept,
             std::vector<float>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    T value;
    std::memcpy(&value, from.data() + i * sizeof(T), sizeof(T));
    to[i] = static_cast<float>(static_cast<double>(value) * slope + intercept);
  }
}

[[noreturn]] void fail_slice(const std::string& file, const std::string& wrong) {
  fail_input(file, wrong, "export the series again, or remove the file");
}

bool has_magic(const std::string& file) {
  char head[132] = {};
  Input input(file);
  input.stream().read(head, sizeof head);
  return input.stream().gcount() == sizeof head && std::memcmp(head + 128, "DICM", 4) == 0;
}

// One slice with its place, and the series it is of; nothing when the file is no image.
std::optional<std::pair<std::string, Slice>> read_slice(const std::string& file) {
  gdcm::ImageReader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) return {};
  const gdcm::Image& image = reader.GetImage();
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  gdcm::Attribute<0x0020, 0x000e> series;
  series.SetFromDataSet(set);
  Slice slice;
  slice.file = file;
  const unsigned* size = image.GetDimensions();
  if (image.GetNumberOfDimensions() == 3 && size[2] > 1) {
    fail_slice(file, "it holds several frames");
  }
  slice.columns = static_cast<int>(size[0]);
  slice.rows = static_cast<int>(size[1]);
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const double pixels = static_cast<double>(size[0]) * size[1];
  const double bytes = static_cast<double>(std::filesystem::file_size(file));
  if (format.GetSamplesPerPixel() != 1) fail_slice(file, "its pixels have colours");
  // JPEG and run-length coding pack a flat slice hard, yet not a thousandfold.
  if (pixels < 4 || pixels * format.GetPixelSize() > 2000 * bytes) {
    fail_slice(file,
               fmt::format("it claims {} x {} pixels, which it cannot hold", size[0], size[1]));
  }
  if (!set.FindDataElement(gdcm::Tag(0x0020, 0x0032))) {
    fail_slice(file, "it does not say where the slice lies (ImagePositionPatient)");
  }
  std::vector<char> buffer(image.GetBufferLength());
  if (buffer.size() < static_cast<std::size_t>(pixels) * format.GetPixelSize() ||
      !image.GetBuffer(buffer.data())) {
    fail_slice(file, "its pixels are damaged or packed in an unknown way");
  }
  slice.values.resize(static_cast<std::size_t>(pixels));
  const double slope = image.GetSlope(), intercept = image.GetIntercept();
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      convert<std::uint8_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT8:
      convert<std::int8_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      convert<std::uint16_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      convert<std::int16_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::UINT32:
      convert<std::uint32_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT32:
      convert<std::int32_t>(buffer, slope, intercept, slice.values);
      break;
    default:
      fail_slice(file, "its pixels are of an unknown kind");
  }
  const double* cosines = image.GetDirectionCosines();
  for (int k = 0; k < 3; ++k) {
    slice.origin[k] = image.GetOrigin(static_cast<unsigned>(k));
    slice.along_row[k] = cosines[k];
    slice.along_column[k] = cosines[k + 3];
  }
  slice.spacing = {image.GetSpacing(0), image.GetSpacing(1)};
  const char* uid = series.GetValue().c_str();
  return std::pair(std::string(uid == nullptr ? "" : uid), std::move(slice));
}

}  // namespace

Volume read_dicom_series(const std::string& folder) {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  std::map<std::string, std::vector<Slice>> series;
  gdcm::Directory directory;
  directory.Load(folder.c_str(), false);
  std::vector<std::string> files = directory.GetFilenames();
  std::sort(files.begin(), files.end());
  std::size_t strange = 0;
  for (const std::string& file : files) {
    std::optional<std::pair<std::string, Slice>> slice;
    if (has_magic(file)) slice = read_slice(file);
    if (slice) {
      series[slice->first].push_back(std::move(slice->second));
    } else {
      ++strange;
    }
  }
  if (series.empty()) {
    fail_input(folder, "there is no DICOM image in it", "give the folder that holds the slices");
  }
  auto largest = series.begin();
  for (auto at = series.begin(); at != series.end(); ++at) {
    if (at->second.size() > largest->second.size()) largest = at;
  }
  std::vector<Slice>& slices = largest->second;
  Volume volume;
  volume.format = fmt::format("DICOM, {} slices", slices.size());
  if (series.size() > 1) {
    volume.notes.push_back(fmt::format("of {} series the largest taken", series.size()));
  }
  if (strange > 0) volume.notes.push_back(fmt::format("{} files are no images", strange));

  const Slice& first = slices.front();
  const Eigen::Vector3d normal = first.along_row.cross(first.along_column);
  std::sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
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
    const Slice& s = slices[k];
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
