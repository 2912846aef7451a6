// From the points of a scan to the closed outward surface of a body.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mesh/surface.h"

namespace hapsim {

enum class ReconstructMethod {
  kAuto,
  kHeight,
  kDelaunay,
  kPowerCrust,
  kPoisson,
  kAdvancingFront,
  kWrap
};

// In the order of the enumeration: "auto", "height", ...
const std::vector<std::string>& reconstruct_methods();
const std::string& method_name(ReconstructMethod method);
// kAuto for a name that is none.
ReconstructMethod method_named(const std::string& name);

struct ReconstructOptions {
  ReconstructMethod method = ReconstructMethod::kAuto;
  std::optional<double> base;              // height of the bottom plane along `up` [m]
  std::optional<double> base_depth;        // ... or its depth below the lowest point [m]
  std::optional<Vec3> up = Vec3::UnitZ();  // absent: z, or the mean normal when 60 degrees off it
  bool no_base = false;                    // points from all round: leave the underside as it is
  double beyond = 0;  // the body goes on by so much beyond the points [m]; 0: it ends with them;
                      // negative: by its thickness there, half of the points' width at most
  double edge = 0;    // wished edge length [m]; 0: from size and sampling
  std::uint64_t seed = 1;
  std::function<void()> step;  // called a few times on the way, for progress; may be empty
};

struct ReconstructReport {
  ReconstructMethod method = ReconstructMethod::kAuto;
  std::string why;  // what in the points, or which flag, decided
  Vec3 up = Vec3::UnitZ();
  bool tilted = false;   // up is not z
  bool has_base = true;  // a flat bottom at height `base` along `up`
  double base = 0;       // [m]
  std::string base_why;
  double beyond = 0;         // [m]
  std::vector<Vec3> window;  // outline of the points, where the body goes on beyond them
  double edge = 0;           // [m]
  std::size_t points = 0;    // used, after thinning
  bool sharp = false;        // sharp edges were restored
  double rms = 0;            // of the given points to the surface [m]
  double far_share = 0;      // points farther than three times that
};

// Closed, outward, one part, without self-intersection; the bottom, where there is one, exactly
// planar. Points without normals get them.
// - height, for points of the upper side only: a regularised outline in plan view, heights by
//   smoothed least squares with the smoothing chosen by cross-validation, upright side walls, flat
//   bottom. `beyond`: the surface goes on smoothly as far as that, the walls stand there.
// - the others, for points of the side too: triangles over the points, mirrored at the base plane
//   (so that the walls run down to it and overhang may be), cut flat there; for points all round,
//   cut flat just above the lowest, as a support; then remeshed evenly, fitted to the points, sharp
//   edges restored. raw_surface.h and poisson.h have what each does.
// Auto takes height or poisson by what was seen (height where hardly a point is steep and the
// bottom is given clearly below the points), and the best of the others where poisson fails or
// leaves the points far off.
// Error(kBadInput) for points that give no surface, by auto also when no method makes a sound body
// of them; Error(kNoConvergence) when a method that was asked for does not.
Surface reconstruct(const PointCloud& cloud, const ReconstructOptions& options,
                    const std::string& name, ReconstructReport& report);

// Error(kBadInput) when the middle 96 % of the points span more than 5 m or less than 1 mm: read in
// another unit than they were written in.
void check_size(const std::vector<Vec3>& points, const std::string& unit, const std::string& name);

}  // namespace hapsim
