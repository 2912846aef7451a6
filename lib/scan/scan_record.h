// What is told of how a scan became points: sentences, and JSON.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/summary.h"
#include "reconstruct/clean_points.h"
#include "scan/register.h"
#include "scan/scan.h"
#include "scan/touch.h"
#include "volume/isosurface.h"

namespace hapsim {

struct ScanRecord {
  struct VolumeRead {
    std::string format;
    std::array<int, 3> size{};  // voxels
    IsoReport surface;
  };
  std::optional<VolumeRead> volume;          // the scan is the surface of one
  std::optional<RegisterReport> registered;  // zones were brought together
  std::optional<TouchReport> touch;          // an indentation was undone
  CleanReport cleaned;
  double spacing = 0;   // of the points that were kept [m]
  std::string normals;  // where they come from
};

// The surface of a volume as a scan, with notes on what was found. Errors as isosurface().
Scan scan_of_volume(const Volume& volume, const IsoOptions& options, const std::string& name,
                    ScanRecord& record);

// Normals of the cleaned points (index[i]: number in the scan of point i) where they have none,
// turned to the sensor where the scan knows it. Where they come from, in words.
std::string complete_normals(PointCloud& clean, const Scan& scan, const std::vector<int>& index);

std::vector<std::string> zone_lines(const RegisterReport& report);
std::string touch_words(const TouchReport& report);
// On a screen: what was read, removed and kept; `frame`: that the points were read in, "mm".
Summary points_summary(const ScanRecord& record, const std::string& frame);

// All of it as JSON text (two spaces of indent, a newline at the end), in SI.
std::string scan_json(const ScanRecord& record);

}  // namespace hapsim
