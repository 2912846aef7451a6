// What is told of a surface that was made or mended: a summary, comments for its file, and JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/summary.h"
#include "reconstruct/reconstruct.h"
#include "repair/repair.h"

namespace hapsim {

struct SurfaceRecord {
  Summary summary;
  std::vector<std::string> comments;  // method, seed, base plane
  std::string json;                   // text, two spaces of indent, a newline at the end
};

// Made of so many points.
SurfaceRecord record_reconstruction(const Surface& surface, const ReconstructReport& report,
                                    std::size_t points, std::uint64_t seed);

// Made of so many triangles: mended, as `report` says, or (null) wrapped.
SurfaceRecord record_repair(const Surface& surface, const RepairReport* report,
                            std::size_t triangles);

}  // namespace hapsim
