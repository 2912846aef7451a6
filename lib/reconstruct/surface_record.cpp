#include "reconstruct/surface_record.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/number.h"
#include "mesh/window.h"

namespace hapsim {
namespace {

SurfaceRecord finish(SurfaceRecord record, nlohmann::json json, const Surface& surface) {
  json["vertices"] = surface.vertices.size();
  json["faces"] = surface.faces.size();
  json["volume"] = signed_volume(surface);
  record.json = json.dump(2) + "\n";
  return record;
}

}  // namespace

SurfaceRecord record_reconstruction(const Surface& surface, const ReconstructReport& report,
                                    std::size_t points, std::uint64_t seed) {
  SurfaceRecord record;
  const std::string& method = method_name(report.method);
  record.comments = {fmt::format("hs-reconstruct: method {}, seed {}", method, seed),
                     fmt::format("method {}: {}", method, report.why)};
  std::string base = "no flat bottom";
  if (report.has_base) {
    const std::string plane =
        fmt::format("{} {} {} {}", format_number(report.up.x()), format_number(report.up.y()),
                    format_number(report.up.z()), format_number(report.base));
    record.comments.push_back("base_plane " + plane);
    base = report.tilted ? "base n.x = h with (nx ny nz h) = (" + plane + ")"
                         : fmt::format("base z = {:.4g} m", report.base);
    base += " (" + report.base_why + ")";
  }
  if (!report.window.empty()) {
    record.comments.push_back(window_comment(report.window));
    base += fmt::format(
        "; the body goes on for {:.3g} mm beyond the points, where its shape is a guess",
        1e3 * report.beyond);
  }
  Summary& told = record.summary;
  told.verdict =
      fmt::format("a closed surface of {} faces, method {}", surface.faces.size(), method);
  told.size = fmt::format("{:.4g} cm^3", 1e6 * signed_volume(surface));
  told.items = {
      {"METHOD", "", "", {fmt::format("{}: {}", method, report.why)}},
      {"POINTS",
       "",
       "",
       {fmt::format("{} points ({} after evening out), which lie {:.2g} mm rms off the surface, "
                    "{:.1f} % farther than 3 times that",
                    points, report.points, 1e3 * report.rms, 100 * report.far_share)}},
      {"SURFACE",
       "",
       "",
       {fmt::format("{} vertices, {} faces of edge {:.2g} mm, {}; {}", surface.vertices.size(),
                    surface.faces.size(), 1e3 * report.edge,
                    report.sharp ? "with sharp edges" : "without sharp edges", base)}}};
  nlohmann::json json = {{"method", method},    {"why", report.why},
                         {"points", points},    {"points_used", report.points},
                         {"edge", report.edge}, {"sharp_edges", report.sharp},
                         {"rms", report.rms},   {"far_share", report.far_share}};
  if (report.has_base) json["base"] = report.base;
  if (report.beyond > 0) json["beyond"] = report.beyond;
  return finish(std::move(record), std::move(json), surface);
}

SurfaceRecord record_repair(const Surface& surface, const RepairReport* report,
                            std::size_t triangles) {
  SurfaceRecord record;
  const bool wrapped = report == nullptr;
  const std::string method = wrapped ? "wrap" : "repair";
  const std::string why = wrapped ? "asked for" : "the input has triangles";
  record.comments = {fmt::format("hs-reconstruct: method {}", method),
                     fmt::format("method {}: {}", method, why)};
  Summary& told = record.summary;
  told.verdict =
      fmt::format("a closed surface of {} faces, method {}", surface.faces.size(), method);
  told.size = fmt::format("{:.4g} cm^3", 1e6 * signed_volume(surface));
  told.items = {
      {"METHOD", "", "", {fmt::format("{}: {}", method, why)}},
      {"SURFACE",
       "",
       "",
       {fmt::format("{} triangles to {} vertices, {} faces; {}", triangles, surface.vertices.size(),
                    surface.faces.size(), wrapped ? "wrapped, nothing mended" : report->text())}}};
  nlohmann::json json = {{"method", method}, {"why", why}, {"triangles", triangles}};
  if (!wrapped) json["repairs"] = nlohmann::json::parse(report->json());
  return finish(std::move(record), std::move(json), surface);
}

}  // namespace hapsim
