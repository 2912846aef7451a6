#include "scan/scan_record.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "reconstruct/normals.h"
#include "scan/orient.h"

namespace hapsim {
namespace {

std::string merge_words(const MergeReport& merged) {
  return fmt::format(
      "{} points became {}, each the mean of those about it, some {:.2g} mm apart{}", merged.before,
      merged.after, 1e3 * merged.spacing,
      merged.asked ? ", as asked"
      : merged.noise * kMergeNoises > 0.7 * merged.spacing
          ? fmt::format(": with noise of {:.2g} mm closer ones say no more", 1e3 * merged.noise)
          : ": more say no more of the surface; --spacing sets it");
}

}  // namespace

Scan scan_of_volume(const Volume& volume, const IsoOptions& options, const std::string& name,
                    ScanRecord& record) {
  IsoReport report;
  Scan scan;
  scan.cloud = isosurface(volume, options, name, report);
  scan.notes = volume.notes;
  scan.notes.push_back(fmt::format(
      "{}, {} x {} x {} voxels: the body has {} ({:.1f} % of all beyond the threshold, {} parts); "
      "{:.0f} MB taken",
      volume.format, volume.size[0], volume.size[1], volume.size[2], report.voxels,
      100 * report.share, report.parts, report.memory / 1e6));
  if (report.cut > 0) {
    scan.notes.push_back(
        fmt::format("WARNING the volume's border cuts the body at {} voxels", report.cut));
  }
  record.volume = {volume.format, volume.size, report};
  return scan;
}

std::string complete_normals(PointCloud& clean, const Scan& scan, const std::vector<int>& index) {
  if (!clean.normals.empty()) return "given";
  NormalsReport report;
  estimate_normals(clean, Vec3::UnitZ(), report);
  std::string text = fmt::format("from {} neighbours, noise about {:.2g} mm", report.neighbours,
                                 1e3 * report.noise);
  if (scan.to_sensor.empty()) return text;
  face_sensor(clean, pick(scan, index).to_sensor);
  return text + ", towards the sensor";
}

std::vector<std::string> zone_lines(const RegisterReport& report) {
  std::vector<std::string> lines;
  for (const ZoneMotion& z : report.zones)
    lines.push_back(
        z.name == report.fixed
            ? fmt::format("zone {} stays; rms {:.3f} to {:.3f} mm in {} matches", z.name,
                          1e3 * z.rms_before, 1e3 * z.rms_after, z.overlap)
            : fmt::format(
                  "zone {} shifted by {:.3f} {:.3f} {:.3f} mm (+- {:.3f}), turned by {:.3f} "
                  "deg; rms {:.3f} to {:.3f} mm in {} matches",
                  z.name, 1e3 * z.shift.x(), 1e3 * z.shift.y(), 1e3 * z.shift.z(), 1e3 * z.error,
                  z.turn * 180 / M_PI, 1e3 * z.rms_before, 1e3 * z.rms_after, z.overlap));
  return lines;
}

std::string touch_words(const TouchReport& report) {
  return fmt::format("indentation of the touch undone: {:.3f} mm ({:.3f} to {:.3f})",
                     1e3 * report.mean, 1e3 * report.least, 1e3 * report.largest);
}

Summary points_summary(const ScanRecord& record, const std::string& frame) {
  const CleanReport& cleaned = record.cleaned;
  Summary s;
  s.verdict = fmt::format("{} of {} points kept", cleaned.kept, cleaned.read);
  s.size = fmt::format("{:.3g} mm apart", 1e3 * record.spacing);
  s.items = {{"POINTS",
              "",
              "",
              {fmt::format(
                  "{} points read in {}; removed {} given twice, {} nearly so, {} isolated, {} off "
                  "the surface, {} by thinning; kept {}",
                  cleaned.read, frame, cleaned.duplicates, cleaned.near_duplicates,
                  cleaned.isolated, cleaned.off_surface, cleaned.thinned(), cleaned.kept)}},
             {"NORMALS", "", "", {record.normals}}};
  if (cleaned.thinned() > 0) s.items.push_back({"THINNED", "", "", {merge_words(cleaned.merged)}});
  return s;
}

std::string scan_json(const ScanRecord& record) {
  nlohmann::json json;
  if (record.volume) {
    const IsoReport& surface = record.volume->surface;
    json["volume"] = {{"format", record.volume->format}, {"size", record.volume->size},
                      {"body_voxels", surface.voxels},   {"parts", surface.parts},
                      {"cut_voxels", surface.cut},       {"memory_bytes", surface.memory}};
  }
  if (record.registered)
    for (const ZoneMotion& z : record.registered->zones)
      json["zones"].push_back({{"zone", z.name},
                               {"fixed", z.name == record.registered->fixed},
                               {"points", z.points},
                               {"matches", z.overlap},
                               {"shift", {z.shift.x(), z.shift.y(), z.shift.z()}},
                               {"turn", z.turn},
                               {"shift_std_error", z.error},
                               {"rms_before", z.rms_before},
                               {"rms_after", z.rms_after}});
  if (record.touch) {
    const TouchReport& report = *record.touch;
    json["indentation"] = {
        {"mean", report.mean}, {"least", report.least}, {"largest", report.largest}};
  }
  const CleanReport& cleaned = record.cleaned;
  json["points"] = {{"read", cleaned.read},
                    {"duplicates", cleaned.duplicates},
                    {"near_duplicates", cleaned.near_duplicates},
                    {"isolated", cleaned.isolated},
                    {"off_surface", cleaned.off_surface},
                    {"thinned", cleaned.thinned()},
                    {"kept", cleaned.kept},
                    {"spacing", record.spacing},
                    {"normals", record.normals}};
  return json.dump(2) + "\n";
}

}  // namespace hapsim
