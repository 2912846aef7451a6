// The parts of reconstruct(): all in a frame whose z is `up`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/reconstruct.h"

namespace hapsim {

// What the points show of a body.
struct ScanView {
  double spacing = 0;  // distance of neighbouring points [m]
  double low = 0;      // level of the lowest points [m]: their 0.5 % quantile
  double high = 0;
  double area = 0;         // of what was scanned, estimated [m^2]
  double under_cover = 0;  // share of the plan view that was seen from below too
  double ring_cover = 0;   // share of directions in which points reach down to the lowest band
  double steep_share = 0;  // share of points on upright walls or under overhangs
};
ScanView view_scan(const PointCloud& cloud);

// One point a cell of a third of `edge` where the scan is denser than that: noise and doubled
// passes average out, and each piece of the surface counts alike.
PointCloud even_points(const PointCloud& cloud, double spacing, double edge);

struct BodyFrame {
  bool has_base = true;
  bool all_round = false;  // the underside was scanned: cut at the base, not mirrored there
  double base = 0;         // [m]
  double edge = 0;         // [m]
  double beyond = 0;       // the body goes on beyond the points by this [m]
  double spacing = 0;      // of the points [m]
  bool roughly = false;    // the Poisson surface, before it is fitted: of fewer points
  std::uint64_t seed = 1;
  std::function<void()> step;
};

// Points with normals, of side and upper surface (or all round without a base), by any method but
// kHeight: triangles by the method, cut flat, made even, fitted, sharp edges restored.
// Error(kNoConvergence, kBadInput) where the method gives no closed surface.
// `sharp`: whether there were any.
Surface reconstruct_closed(const PointCloud& cloud, const BodyFrame& frame,
                           ReconstructMethod method, bool& sharp);
// Points of the upper surface.
Surface reconstruct_height(const PointCloud& cloud, const BodyFrame& frame);
// The outline of these points, counter-clockwise, at the height of the base.
std::vector<Vec3> outline_of(const PointCloud& cloud, const BodyFrame& frame);

}  // namespace hapsim
