// The ways that a place of a body is pressed along to learn how a flat tool slips there.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/tetmesh.h"

namespace hapsim {

// A way of the tool from no displacement, or from a step of another motion on.
struct SlipMotion {
  int after = -1, from = 0;  // of that: which, and how many of its steps; -1: from the beginning
  // In the sample's frame: depth and ways aside in tool radii; forces that move the tool, less the
  // sideways part of those that a tool which holds has straight down at the depth in the same
  // elements, over their normal part.
  std::vector<Vec3> way, force;
};

constexpr double kSlipStep = 0.15;  // of depth straight in, in tool radii
// A tool that holds is pressed straight in at each of these: all ways keep to such depths.
constexpr double kSlipPart = kSlipStep / 3;
// Tool radii, of what is drawn at random where finer elements converge too.
constexpr double kSlipWayDepth = 0.68;
constexpr int kSlipNear = 5;  // steps straight in to which they do

// Of planned_slip_ways(): where these are. Those after kSlipFixed are drawn at random.
enum SlipWay {
  kSlipIn,
  kSlipOut,
  kSlipAcross,
  kSlipInDrawn,
  kSlipOutDrawn,
  kSlipOutDeep,
  kSlipOutDrawnDeep,
  kSlipFixed
};

// Straight in by `depths` steps, and out again from there and from less; in and aside as far as it
// slips, back and over; in while it is drawn aside so far that it hardly holds, and out the same
// way; and what `seed` draws, without which the rings that are fitted are off by 2 % and more where
// a tool goes out after turns or round and round: ways from corner to corner, around a circle, and
// in and out while it goes on, seven to kSlipWayDepth and, of more than kSlipNear steps, five as
// deep as these. `across`: along the surface, where the way in has no part, so that the tool is not
// pushed aside by it. Forces are empty.
std::vector<SlipMotion> planned_slip_ways(const Eigen::Vector2d& across, double friction,
                                          int depths, std::uint64_t seed);

}  // namespace hapsim
