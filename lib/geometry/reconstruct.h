// From the points of a scan to the closed outward surface of a body.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "geometry/surface.h"

namespace hapsim {

enum class ReconstructMethod { kAuto, kHeight, kPoisson };

struct ReconstructOptions {
  ReconstructMethod method = ReconstructMethod::kAuto;
  std::optional<double> base;              // height of the bottom plane along `up` [m]
  std::optional<double> base_depth;        // ... or its depth below the lowest point [m]
  std::optional<Vec3> up = Vec3::UnitZ();  // absent: z, or the mean normal when 60 degrees off it
  bool no_base = false;                    // points from all round: leave the underside as it is
  double edge = 0;                         // wished edge length [m]; 0: from size and sampling
  std::uint64_t seed = 1;
};

struct ReconstructReport {
  std::string method;  // "height" or "poisson"
  std::string why;     // what in the points, or which flag, decided
  Vec3 up = Vec3::UnitZ();
  bool tilted = false;   // up is not z
  bool has_base = true;  // a flat bottom at height `base` along `up`
  double base = 0;       // [m]
  std::string base_why;
  double edge = 0;         // [m]
  std::size_t points = 0;  // used, after thinning
  double rms = 0;          // of the given points to the surface [m]
  double far_share = 0;    // points farther than three times that
};

// Closed, outward, one part, without self-intersection; the bottom, where there is one, exactly
// planar. Points without normals get them. Two ways:
// - height: a regularised outline in plan view, heights by smoothed least squares with the
// smoothing
//   chosen by cross-validation, upright side walls, flat bottom. For points of the upper side only.
// - poisson: for points of the side too, mirrored at the base plane (so that the walls run down to
// it
//   and overhang may be), cut flat there; for points all round, cut flat just above the lowest, as
//   a support.
// Then remeshed evenly and fitted to the points. Error(kBadInput) for points that give no surface,
// Error(kNoConvergence) with the place when the result fails its check.
Surface reconstruct(const PointCloud& cloud, const ReconstructOptions& options,
                    const std::string& name, ReconstructReport& report);

}  // namespace hapsim
