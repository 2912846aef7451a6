// What reconstruction decides where it is not told: what is up, the method, the bottom.
#pragma once

#include <string>

#include "reconstruct/reconstruct.h"
#include "reconstruct/reconstruct_parts.h"

namespace hapsim {

constexpr double kSeenBelow = 0.5;  // share of the plan view: a scan from all round

// The direction that is up, from the normals when it is to be found.
Vec3 find_up(const PointCloud& cloud, const ReconstructOptions& options);
// Chooses the method and says why; sets has_base.
void choose_method(const ScanView& view, const ReconstructOptions& options,
                   ReconstructReport& report);
// The height of the bottom, and why. Error(kBadInput) where the one given is none.
void choose_base(const ScanView& view, const ReconstructOptions& options, const std::string& name,
                 ReconstructReport& report);
// How far a body goes on beyond the points.
double beyond_points(const ScanView& view, const ReconstructOptions& options, double base);

}  // namespace hapsim
