#include "import/import_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/error.h"
#include "io/csv.h"

namespace hapsim {

Summary import_summary(const ImportResult& result) {
  const Recording& out = result.recording;
  double force = 0, depth = 0;
  std::size_t air = 0;
  for (std::size_t i = 0; i < out.rows(); ++i) {
    force = std::max(force, out.f[i].norm());
    air += out.in_air(i);
    if (!out.in_air(i)) depth = std::max(depth, out.u[i].norm());
  }
  std::vector<Vec3> places;
  for (const TouchedPoint& touched : result.touched)
    if (std::none_of(places.begin(), places.end(),
                     [&](const Vec3& p) { return (p - touched.point).norm() < 1e-6; }))
      places.push_back(touched.point);
  Summary s;
  for (const std::string& warning : result.notes.warnings) s.notes.push_back("WARNING: " + warning);
  if (!out.metadata.find("tool_radius"))
    s.notes.emplace_back(
        "WARNING: the tool's radius is unknown, and the other tools need it: --tool-radius");
  s.mark = s.notes.empty() ? Summary::Mark::kGood : Summary::Mark::kOpen;
  s.verdict =
      fmt::format("{}: {} at {}", out.name, counted(out.presses().size(), "press", "presses"),
                  counted(places.size(), "position", "positions"));
  s.size = fmt::format("{}", counted(out.rows(), "sample", "samples"));
  s.items.push_back({"SIZE",
                     "",
                     "",
                     {fmt::format("depth up to {:.3g} mm, force up to {:.3g} N; {} in the air, {}",
                                  1e3 * depth, force, counted(air, "sample", "samples"),
                                  out.t.empty() ? "quasi-static" : "with time")}});
  if (!result.notes.facts.empty()) s.items.push_back({"READ", "", "", result.notes.facts});
  s.values = {{"presses", static_cast<double>(out.presses().size()), "1"},
              {"positions", static_cast<double>(places.size()), "1"},
              {"samples", static_cast<double>(out.rows()), "1"},
              {"samples_in_air", static_cast<double>(air), "1"},
              {"depth", depth, "m"},
              {"force", force, "N"}};
  return s;
}

void write_scan(std::ostream& out, const ImportResult& result) {
  const bool normals = !result.touched.empty() && result.touched.front().normal.norm() > 0.5;
  Metadata metadata;
  metadata.set("source", result.recording.name);
  CsvWriter writer(out, metadata,
                   normals ? std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz"}
                           : std::vector<std::string>{"x", "y", "z"});
  for (const TouchedPoint& touched : result.touched) {
    std::vector<std::string> row;
    for (Eigen::Index i = 0; i < 3; ++i) row.push_back(format_number(touched.point[i]));
    for (Eigen::Index i = 0; normals && i < 3; ++i) row.push_back(format_number(touched.normal[i]));
    writer.row(row);
  }
}

std::optional<Vec3> contact_place(const std::optional<Vec3>& at, const std::optional<Vec3>& block) {
  if (!block) return at;
  if (!at) return Vec3(0, 0, block->z());
  if (std::abs(at->x()) > block->x() / 2 || std::abs(at->y()) > block->y() / 2 ||
      std::abs(at->z() - block->z()) > 1e-6)
    fail_usage("--at is not on the top of the block",
               fmt::format("its z is {} and its middle is x = y = 0", block->z()));
  return at;
}

}  // namespace hapsim
